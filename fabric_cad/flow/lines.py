"""The Laplacian inverted line by line: all nodes that stand above each other, and those alone.

Layers are thinner than elements are wide, so that the neighbours on a vertical line are the ones
that pull most.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components

from ..meshing.hexahedron import EDGES
from .quadratic import PLACES, QuadraticMesh

_UPRIGHT = 0.7  # of an edge's length that is height


def vertical_links(mesh: QuadraticMesh) -> np.ndarray:
    """Pairs (pairs, 2) of nodes that stand above each other in hexahedra one of whose axes is upright."""
    corners = mesh.mesh.points[mesh.mesh.hexahedra]
    along = corners[:, EDGES[..., 1]] - corners[:, EDGES[..., 0]]  # (elements, axes, edges, 3)
    upright = (np.abs(along[..., 2]) > _UPRIGHT * np.linalg.norm(along, axis=3)).all(axis=2)
    pairs = []
    for axis in range(3):
        lower = np.flatnonzero(PLACES[:, axis] < 1)
        own = mesh.nodes[upright[:, axis]]
        pairs.append(np.stack([own[:, lower], own[:, lower + 3**axis]], axis=-1).reshape(-1, 2))
    return np.concatenate(pairs)


def lines_of(links: np.ndarray, count: int) -> np.ndarray:
    """For each of ``count`` nodes the number (count,) of the line it stands on, from ``links`` (pairs, 2)."""
    graph = coo_array(
        (np.ones(len(links), dtype=np.int8), (links[:, 0], links[:, 1])), shape=(count, count)
    )
    return connected_components(graph.tocsr(), directed=False)[1]


def line_inverse(matrix: csr_array, line: np.ndarray) -> csr_array:
    """The inverse of the blocks of nodes on the same ``line`` (nodes,); a positive definite matrix.

    Where no two nodes stand on one that is the inverse of the diagonal.
    """
    order = np.argsort(line, kind="stable")
    counts = np.bincount(line)
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    slot = np.empty(len(line), dtype=np.int64)
    slot[order] = np.arange(len(line)) - np.repeat(starts, counts)

    entries = matrix.tocoo()
    own = line[entries.row] == line[entries.col]
    row, column, data = entries.row[own], entries.col[own], entries.data[own]
    rows, columns, inverses = [], [], []

    for count in np.unique(counts):  # lines of equal length together
        lines = np.flatnonzero(counts == count)
        place = np.full(len(counts), -1)
        place[lines] = np.arange(len(lines))
        chosen = place[line[row]] >= 0
        blocks = np.zeros((len(lines), count, count))
        blocks[place[line[row[chosen]]], slot[row[chosen]], slot[column[chosen]]] = data[chosen]

        members = order[starts[lines][:, None] + np.arange(count)]
        inverses.append(np.linalg.inv(blocks).ravel())
        rows.append(np.repeat(members, count, axis=1).ravel())
        columns.append(np.tile(members, (1, count)).ravel())

    values = (np.concatenate(inverses), (np.concatenate(rows), np.concatenate(columns)))
    inverse = coo_array(values, shape=matrix.shape).tocsr()
    return (inverse + inverse.T) / 2
