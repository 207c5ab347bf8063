"""The two colours of every picture and STEP file."""

COLOURS = {"weft": (0.88, 0.52, 0.18), "warp": (0.20, 0.42, 0.62)}
"""Red, green, blue of the yarns of either direction, from 0 to 1."""
