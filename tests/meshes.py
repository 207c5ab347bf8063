"""Straight yarns of rectangular section, meshed by hand."""

import numpy as np
from scipy.spatial.transform import Rotation

from fabric_cad.meshing.mesh import Mesh
from fabric_cad.weave.bodies import Body, Surface

LENGTH, WIDTH, HEIGHT = 4.0, 2.0, 0.5


def mesh_named(points, hexahedra, body, names, surfaces):
    """A mesh whose bodies and surfaces are given by their names."""
    named = {Surface.named(name): quads for name, quads in surfaces.items()}
    return Mesh(points, hexahedra, body, tuple(map(Body.named, names)), named)


def box(name, place=(0.0, 0.0, 0.0), turn=0.0, parts=(8, 6, 2)):
    """A straight yarn of rectangular section along x (then turned about z by ``turn``), its middle at ``place``."""
    number = np.arange(np.prod(np.add(parts, 1))).reshape(np.add(parts, 1))
    grid = np.stack(
        np.meshgrid(*(np.linspace(-0.5, 0.5, n + 1) for n in parts), indexing="ij"), axis=-1
    )
    points = (
        Rotation.from_euler("z", turn).apply(grid.reshape(-1, 3) * [LENGTH, WIDTH, HEIGHT]) + place
    )

    def quads(sheet):
        corners = (sheet[:-1, :-1], sheet[1:, :-1], sheet[1:, 1:], sheet[:-1, 1:])
        return np.stack([each.ravel() for each in corners], axis=1)

    layers = np.array([quads(sheet) for sheet in number])
    hexahedra = np.concatenate([layers[:-1], layers[1:]], axis=2).reshape(-1, 8)
    sides = [quads(number[:, 0]), quads(number[:, -1]), quads(number[:, :, -1])]
    surfaces = {
        f"{name}_contact": quads(number[:, :, 0]),
        f"{name}_free": np.vstack(sides),
        f"{name}_start": quads(number[0]),
        f"{name}_end": quads(number[-1]),
    }
    return mesh_named(points, hexahedra, np.zeros(len(hexahedra), dtype=int), (name,), surfaces)


def together(*meshes):
    """One mesh of several yarns."""
    first = np.cumsum([0, *(len(mesh.points) for mesh in meshes)])
    return Mesh(
        np.vstack([mesh.points for mesh in meshes]),
        np.vstack([mesh.hexahedra + n for mesh, n in zip(meshes, first)]),
        np.repeat(np.arange(len(meshes)), [len(mesh.hexahedra) for mesh in meshes]),
        tuple(mesh.bodies[0] for mesh in meshes),
        {
            name: quads + n
            for mesh, n in zip(meshes, first)
            for name, quads in mesh.surfaces.items()
        },
    )
