"""Weaves, patterns and the yarns of a cell."""
