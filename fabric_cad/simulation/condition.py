"""What tells whether a state of a loaded cell can be trusted."""

from __future__ import annotations

from .energy import cell_energy
from .laws import YarnLaw
from .penetration import penetration
from .reached import Deformed


def condition(deformed: Deformed, law: YarnLaw) -> dict[str, float]:
    """The columns :data:`~fabric_cad.simulation.loads.CONDITION` of a state.

    ``contact_penetration_mm`` between the contact surfaces and ``penetration_mm`` between any two
    yarns, measured on their deformed shapes; ``contact_share`` of the patches; strain energy; the
    least volume ratio in an element.
    """
    reached = deformed.reached
    energy = cell_energy(deformed.mesh, reached.displacement, law)

    return {
        "contact_penetration_mm": reached.overclosure,
        "penetration_mm": penetration(deformed.mesh, deformed.points, deformed.vectors).depth,
        "contact_share": reached.share,
        "strain_energy_N_mm": energy.strain,
        "least_volume_ratio": energy.least_volume_ratio,
    }
