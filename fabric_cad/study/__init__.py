"""Studies: many fabrics from one base row, factors and a design.

Dask stays behind :mod:`~fabric_cad.study.engine`.
"""

from .definition import Study, read_study
from .run import run_study

__all__ = ["Study", "read_study", "run_study"]
