"""Models with constant sections, beside the present one."""

from .measures import POINTS, TOLERANCE, Comparison, compare, measure
from .models import MODELS, Model
from .tables import comparison_table

__all__ = [
    "MODELS",
    "POINTS",
    "TOLERANCE",
    "Comparison",
    "Model",
    "compare",
    "comparison_table",
    "measure",
]
