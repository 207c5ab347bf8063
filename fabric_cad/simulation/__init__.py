"""Finite element simulations of the elementary cell: decks, runs, and what their results say."""
