"""Errors, files, staging and interrupts: nothing of fabrics."""
