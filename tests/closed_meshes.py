"""Meshes of cells in closed form, without CAD and gmsh: random fabrics by the hundred.

``python tests/closed_meshes.py [COUNT] [--first SEED]`` prints the element quality of the general fabrics
of ``make stability``, and which fall below what their yarns' edges allow.
"""

from __future__ import annotations

import argparse

import numpy as np
from fabrics import random_general_row, skin_of, table

from fabric_cad.meshing.options import mesh_options
from fabric_cad.meshing.plan import plan_yarns
from fabric_cad.meshing.quality import Quality, hexahedra_quality
from fabric_cad.model.identification import identify
from fabric_cad.support.errors import InputError
from fabric_cad.weave.weaves import yarns_of
from fabric_cad.yarn.edges import allowed_scaled_jacobian


def outline_of(fabric, plan):
    """Outline nodes (layers, outline, 3) of a yarn: along, across (from the axis) and up, mm."""
    places = np.full((plan.rows[-1] + 1, plan.template.outline, 3), np.nan)
    for patch in skin_of(fabric, plan.yarn).patches:
        slots, columns = plan.strips[patch.side]
        layers = plan.layers[patch.segment]
        first = plan.rows[patch.segment]
        places[np.arange(first, first + len(layers))[:, None], slots] = patch.at(layers, columns)
    return places


def yarn_nodes(fabric, plan):
    """All nodes (layers, nodes, 3) of a yarn, outline first."""
    outline = outline_of(fabric, plan)
    inner = np.einsum("io,roc->ric", plan.template.weights, outline)
    if plan.moved is not None:
        inner[..., 1:] += plan.moved
    return np.concatenate([outline, inner], axis=1)


def closed_quality(fabric, options=None) -> Quality:
    """Quality of a cell's hexahedra; of yarns that are shifts of each other only the first counts."""
    options = options or mesh_options(fabric)
    different = {}
    for yarn in yarns_of(fabric.weave.interlacement()):
        shifts = [yarn.high[start:] + yarn.high[:start] for start in range(len(yarn.high))]
        different.setdefault((yarn.direction, min(shifts)), yarn)

    points, hexahedra, count = [], [], 0
    for plan in plan_yarns(fabric, list(different.values()), options):
        nodes, quads = yarn_nodes(fabric, plan), plan.template.quads
        layers = count + np.arange(nodes.shape[0])[:, None, None] * nodes.shape[1] + quads
        hexahedra.append(np.concatenate([layers[:-1], layers[1:]], axis=2).reshape(-1, 8))
        points.append(nodes.reshape(-1, 3))
        count += len(points[-1])
    return hexahedra_quality(np.concatenate(points), np.concatenate(hexahedra))


def general_fabric(seed):
    """The solved fabric of a general seed of ``make stability``. Raises InputError where it is refused."""
    family, row = random_general_row(np.random.default_rng(seed), f"r{seed}")
    return identify(table(family, row))[f"r{seed}"]


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("count", type=int, nargs="?", default=200)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    settings = parser.parse_args()
    made, poor = 0, []
    for seed in range(settings.first, settings.first + settings.count):
        try:
            fabric = general_fabric(seed)
            quality = closed_quality(fabric)
        except InputError:
            continue
        made += 1
        least, allowed = quality.scaled_jacobian.min(), allowed_scaled_jacobian(fabric)
        if not least >= min(0.3, 0.9 * allowed):
            poor.append(seed)
        print(
            f"{seed:6d}  {fabric.section:10}  scaled Jacobian {least:.3f} of {allowed:.3f}, "
            f"opposite edges {quality.opposite_edge_ratio.min():.3f}, "
            f"corners {quality.least_angle.min():.1f} deg, aspect {quality.aspect.max():.0f}",
            flush=True,
        )
    print(f"{made} fabrics, below min(0.3, 0.9 of what the edges allow): {poor or 'none'}")


if __name__ == "__main__":
    main()
