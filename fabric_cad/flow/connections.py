"""Along which directions the space of a periodic mesh goes on from cell to cell."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, connected_components

from .quadratic import FACE_NODES, QuadraticMesh


def open_directions(mesh: QuadraticMesh) -> np.ndarray:
    """Orthonormal directions (up to 3, 3) that paths through the space span which lead to their own image.

    A gradient across all of them drives no flow: the space is closed that way.
    """
    first, second, turns = _neighbours(mesh)
    count = len(mesh.nodes)
    graph = coo_array((np.ones(len(first)), (first, second)), shape=(count, count)).tocsr()
    graph = graph + graph.T
    offsets = _offsets(graph, first, second, turns)

    loops = np.unique(offsets[first] + turns - offsets[second], axis=0)
    _, sizes, ways = np.linalg.svd(loops @ mesh.mesh.vectors, full_matrices=False)
    rank = int(np.count_nonzero(sizes > 1e-9 * max(sizes.max(initial=0.0), 1e-300)))
    if rank == 3:
        return np.eye(3)
    spanned = ways[:rank].T @ ways[:rank]
    axes = [axis for axis in np.eye(3) if np.allclose(spanned @ axis, axis)]

    return np.array(axes).reshape(-1, 3) if len(axes) == rank else ways[:rank]


def _neighbours(mesh: QuadraticMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pairs of elements that share a face, and by how many periods (pairs, 3) the second one is further."""
    middles = mesh.nodes[:, FACE_NODES[:, 4]]
    element = np.repeat(np.arange(len(middles)), 6)
    face = mesh.unknowns[middles].ravel()
    order = np.argsort(face, kind="stable")
    same = np.flatnonzero(face[order][1:] == face[order][:-1])
    one, other = order[same], order[same + 1]

    shares = mesh.points[middles.ravel()] @ np.linalg.inv(mesh.mesh.vectors)
    turns = np.round(shares[one] - shares[other]).astype(np.int64)
    return element[one], element[other], turns


def _offsets(graph, first: np.ndarray, second: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """In which cell (elements, 3) every element is, reached from one of its component without closing a loop."""
    count = graph.shape[0]
    step = {pair: turn for pair, turn in zip(zip(first.tolist(), second.tolist()), turns)}
    step |= {pair: -turn for pair, turn in zip(zip(second.tolist(), first.tolist()), turns)}
    offsets = np.zeros((count, 3), dtype=np.int64)
    _, component = connected_components(graph, directed=False)
    for start in np.unique(component, return_index=True)[1]:
        order, before = breadth_first_order(graph, start, directed=False)
        for element in order[1:].tolist():
            parent = int(before[element])
            offsets[element] = offsets[parent] + step[parent, element]
    return offsets
