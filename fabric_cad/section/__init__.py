"""The sections of yarns, and the splines they are drawn with."""
