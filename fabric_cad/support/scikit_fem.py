"""The door to scikit-fem."""

from __future__ import annotations

import logging


def scikit_fem():
    """The package, which takes half a second to import."""
    import skfem

    logging.getLogger("skfem").setLevel(logging.ERROR)  # it warns of copies it makes itself
    return skfem
