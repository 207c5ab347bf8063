"""Input decks for CalculiX and Abaqus: keywords that print themselves, and what they are made of.

``keywords`` are the cards, ``faces`` the mesh's faces as the solvers number them, ``cell`` the
dry cell, ``model`` what a load case adds to it: material, contact, periodicity, steps.
"""
