"""The space between the yarns filled: constituents, and what the composite cell is made of them."""
