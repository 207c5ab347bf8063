"""Models with constant sections, beside the present one."""
