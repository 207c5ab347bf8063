"""Points against trilinear hexahedra and bilinear quadrilaterals, as finite elements shape them.

Nothing is cut into triangles: two faces on the same four nodes are the same surface, whichever
yarn they belong to.
"""

from __future__ import annotations

import numpy as np

from ..meshing.hexahedron import CORNERS

_HEXAHEDRON = CORNERS.astype(float)
_QUADRILATERAL = _HEXAHEDRON[:4, :2]
_STEPS = 25
_CONVERGED = 1e-14
_EDGE = 1e-10  # of the half length of an element, by which a place on its face may miss it
_MISS = 1e-11  # of an element's size, how far from its point a place found may lie


def _powers(corners: np.ndarray, directions: int) -> np.ndarray:
    """Coefficients (elements, terms, 3) of 1, x, y, xy (, z, xz, yz, xyz) from corners (elements, terms, 3)."""
    at = _HEXAHEDRON if directions == 3 else _QUADRILATERAL
    terms = _terms(at)
    return np.einsum("ct,ecd->etd", terms / len(at), corners)


def _terms(at: np.ndarray) -> np.ndarray:
    """1, x, y, xy (, z, xz, yz, xyz) at natural coordinates (places, 2 or 3), shape (places, 4 or 8)."""
    x, y = at[:, 0], at[:, 1]
    plane = np.stack([np.ones_like(x), x, y, x * y], axis=1)
    return plane if at.shape[1] == 2 else np.hstack([plane, plane * at[:, 2:]])


def _slopes(at: np.ndarray) -> np.ndarray:
    """Derivatives (places, directions, terms) of :func:`_terms`."""
    x, y = at[:, 0], at[:, 1]
    one, zero = np.ones_like(x), np.zeros_like(x)
    plane = np.stack([one, x, y, x * y], axis=1)
    by_x, by_y = np.stack([zero, one, zero, y], axis=1), np.stack([zero, zero, one, x], axis=1)
    if at.shape[1] == 2:
        return np.stack([by_x, by_y], axis=1)
    z = at[:, 2:]

    return np.stack(
        [
            np.hstack([by_x, by_x * z]),
            np.hstack([by_y, by_y * z]),
            np.hstack([np.zeros_like(plane), plane]),
        ],
        axis=1,
    )


def inside_hexahedra(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Whether point i lies in hexahedron i (or on its faces), shape (pairs,).

    ``points`` (pairs, 3) and ``corners`` (pairs, 8, 3), in one unit of length and the corner order
    of C3D8. The natural coordinates of the points are found by Newton steps from the middle.
    """
    form = _powers(corners, 3)
    size = np.ptp(corners, axis=1).max(axis=1)
    at = np.zeros_like(points)
    moving = np.arange(len(points))

    for _ in range(_STEPS):
        here = at[moving]
        residual = np.einsum("nt,ntd->nd", _terms(here), form[moving]) - points[moving]
        jacobian = np.einsum("nit,ntd->ndi", _slopes(here), form[moving])
        step = _solve(jacobian, residual)
        at[moving] = np.clip(here - step, -1.5, 1.5)
        moving = moving[np.abs(at[moving] - here).max(axis=1) > _CONVERGED]
        if not len(moving):
            break

    residual = np.einsum("nt,ntd->nd", _terms(at), form) - points

    return (np.abs(at).max(axis=1) <= 1 + _EDGE) & (np.abs(residual).max(axis=1) <= _MISS * size)


def _solve(matrices: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solutions (systems, 3) of 3 x 3 systems by Cramer's rule.

    A singular system gives a step to nowhere.
    """
    a, b, c = np.moveaxis(matrices, 2, 0)
    bc = np.cross(b, c)
    determinant = np.einsum("nd,nd->n", a, bc)
    determinant = np.where(determinant == 0, np.finfo(float).tiny, determinant)
    by = np.stack([bc, np.cross(c, a), np.cross(a, b)], axis=1)
    return np.nan_to_num(
        np.einsum("nid,nd->ni", by, right) / determinant[:, None], posinf=1.0, neginf=-1.0
    )


def distance_to_quads(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Distance (pairs,) of point i to quadrilateral i, in the unit of ``points`` (pairs, 3), ``corners`` (pairs, 4, 3).

    The nearest place is on one of the four edges or where Newton steps from the middle end; exact
    unless a quadrilateral is so warped that it is nearest to the point in two places.
    """
    edges = [_distance_to_segment(points, corners[:, i], corners[:, (i + 1) % 4]) for i in range(4)]
    return np.minimum(np.min(edges, axis=0), _distance_to_inside(points, corners))


def _distance_to_segment(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    along, off = end - start, points - start
    length = np.einsum("nd,nd->n", along, along)
    share = np.clip(np.einsum("nd,nd->n", along, off) / np.where(length > 0, length, 1.0), 0.0, 1.0)
    # from the nearer end, so that the distance to an end itself is 0 to the last bit
    off = np.where((share > 0.5)[:, None], points - end, off)
    return np.linalg.norm(off - np.where(share > 0.5, share - 1, share)[:, None] * along, axis=1)


def _distance_to_inside(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    form = _powers(corners, 2)
    at = np.zeros((len(points), 2))
    moving = np.arange(len(points))

    for _ in range(_STEPS):
        here, part = at[moving], form[moving]
        off = np.einsum("nt,ntd->nd", _terms(here), part) - points[moving]
        by = np.einsum("nit,ntd->nid", _slopes(here), part)
        slope = np.einsum("nid,nd->ni", by, off)
        (xx, xy), (_, yy) = np.moveaxis(np.einsum("nid,njd->nij", by, by), 0, 2)
        twisted = xy + np.einsum("nd,nd->n", off, part[:, 3])
        # Newton's step where it leads down, else Gauss's
        xy = np.where(xx * yy > twisted**2, twisted, xy)
        determinant = np.maximum(xx * yy - xy**2, np.finfo(float).tiny)
        step = np.stack(
            [yy * slope[:, 0] - xy * slope[:, 1], xx * slope[:, 1] - xy * slope[:, 0]], axis=1
        )
        at[moving] = np.clip(here - step / determinant[:, None], -1.0, 1.0)
        moving = moving[np.abs(at[moving] - here).max(axis=1) > _CONVERGED]
        if not len(moving):
            break

    return np.linalg.norm(np.einsum("nt,ntd->nd", _terms(at), form) - points, axis=1)
