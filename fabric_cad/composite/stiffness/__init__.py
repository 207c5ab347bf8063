"""``fabric-cad stiffness``: from a row to the properties of its composite."""
