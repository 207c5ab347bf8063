"""What a periodic cell of hexahedra is like from far away."""
