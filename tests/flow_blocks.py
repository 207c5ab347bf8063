"""Small meshes whose permeability is known in closed form or published."""

import numpy as np

from fabric_cad.composite.homogenisation.periodicity import PeriodicMesh
from fabric_cad.flow.equations import assemble
from fabric_cad.flow.quadratic import QuadraticMesh
from fabric_cad.flow.stokes import stokes_flow
from fabric_cad.meshing.hexahedron import CORNERS

EVERYWHERE = (True, True, True)


def grid(counts):
    """Indices (nodes, 3) of a block's nodes, and its hexahedra."""
    index = np.stack(np.meshgrid(*(np.arange(n + 1) for n in counts), indexing="ij"), axis=-1)
    number = np.arange(index[..., 0].size).reshape(index.shape[:3])
    corners = [
        number[tuple(slice(s, s + n) for s, n in zip(shift, counts))].ravel()
        for shift in (CORNERS + 1) // 2
    ]
    return index.reshape(-1, 3), np.stack(corners, axis=1)


def box(counts, vectors, periodic=EVERYWHERE):
    """A block of hexahedra; ``vectors`` are its edges, or their lengths."""
    vectors = np.diag(vectors) if np.ndim(vectors) == 1 else np.array(vectors)
    index, hexahedra = grid(counts)
    return PeriodicMesh(index / counts @ vectors, hexahedra, vectors, np.zeros(3), periodic)


def around_a_cylinder(radius, sides, rings):
    """The unit square less a circle, one layer thick, with quadratic nodes on the circle."""
    index, hexahedra = grid((rings, 8 * sides, 1))
    angle = 2 * np.pi * index[:, 1] / (8 * sides)
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    outer = way / (2 * np.abs(way).max(axis=1))[:, None]
    share = index[:, :1] / rings
    plan = (1 - share) * radius * way + share * outer + 0.5
    points = np.column_stack([plan, 0.1 * index[:, 2]])
    _, first, number = np.unique(
        np.round(points, 12), axis=0, return_index=True, return_inverse=True
    )
    mesh = PeriodicMesh(
        points[first], number.ravel()[hexahedra], np.diag([1, 1, 0.1]), np.zeros(3), EVERYWHERE
    )
    return on_circle(QuadraticMesh.straight(mesh), radius)


def pipe(radius, count):
    """A disc in the middle of the unit square, one layer thick, with quadratic nodes on the circle."""
    index, hexahedra = grid((count, count, 1))
    x, y = 2 * index[:, 0] / count - 1, 2 * index[:, 1] / count - 1
    disc = radius * np.stack([x * np.sqrt(1 - y**2 / 2), y * np.sqrt(1 - x**2 / 2)], axis=1)
    points = np.column_stack([disc + 0.5, 0.1 * index[:, 2]])
    mesh = PeriodicMesh(points, hexahedra, np.diag([1, 1, 0.1]), np.zeros(3), (False, False, True))
    return on_circle(QuadraticMesh.straight(mesh), radius)


def on_circle(mesh, radius):
    """The mesh with the nodes of its walls moved to the circle in the middle of the unit square."""
    walls = np.unique(mesh.boundary)
    away = mesh.points[walls, :2] - 0.5
    moved = np.zeros_like(mesh.points)
    moved[walls, :2] = away * (radius / np.linalg.norm(away, axis=1, keepdims=True) - 1)
    return mesh.moved(moved)


def flow_between_walls(mesh, directions, tolerance=1e-8):
    """Equations and flow in a mesh whose whole boundary is a wall."""
    fixed = np.zeros((len(mesh.points), 3), dtype=bool)
    fixed[mesh.boundary] = True
    equations = assemble(mesh, fixed)
    return equations, stokes_flow(
        equations, np.array(directions, dtype=float), mesh.mesh.volume, tolerance
    )
