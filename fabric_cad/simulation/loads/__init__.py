"""Load cases, a module each: its settings, states, table, pictures and words.

A new one is a module with a :class:`LoadCase` here, and its name among those registered below.
"""

from .case import CONDITION, Line, LoadCase
from .registry import load_cases, register, unregister
from .shear import ShearCase
from .tension import TensionCase

for _case in (TensionCase, ShearCase):
    register(_case)

__all__ = ["CONDITION", "Line", "LoadCase", "load_cases", "register", "unregister"]
