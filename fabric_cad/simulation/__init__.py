"""Mechanics of a meshed cell: CalculiX run as a child process, and its output files read back.

The finite-element solver stays a program of its own (``ccx``), found on the user's machine and talked
to through files only; nothing here is needed to make a cell, its mesh or its deck.
"""
