"""A solved fabric as the paper's Fig. 15 to 18 draw it, its models compared, what simulations gave.

Each function draws on Matplotlib axes it is given; lengths mm. Those of simulations (Fig. 3, 4, 22a
and 22c) make a figure of their own where they are given none, and return the figure either way.
"""

from .crushing import plot_crushing
from .cuts import plot_cut, plot_edges
from .directions import plot_directions
from .figures import save_figure
from .flow import Section, plot_flow
from .models import plot_gap_maps, plot_model_cuts
from .outlines import sample, section_outline
from .sections import plot_sections
from .sensitivity import plot_sensitivity
from .shear import plot_shear_curve
from .tension import plot_tension_curves, plot_tension_surface
from .trajectories import plot_trajectory

__all__ = [
    "Section",
    "plot_crushing",
    "plot_cut",
    "plot_directions",
    "plot_edges",
    "plot_flow",
    "plot_gap_maps",
    "plot_model_cuts",
    "plot_sections",
    "plot_sensitivity",
    "plot_shear_curve",
    "plot_tension_curves",
    "plot_tension_surface",
    "plot_trajectory",
    "sample",
    "save_figure",
    "section_outline",
]
