"""What is drawn as triangles: a cloth's faces, balls and the shapes of obstacles. Lengths in m."""
from __future__ import annotations

import dataclasses
import math
import typing

import numpy as np
import numpy.typing as npt

from .types import Array, Cloth, Message

_AROUND, _QUARTER = 32, 8  # edges around a ball, and from its pole to its equator
Floats = npt.NDArray[np.float32]
Nodes = npt.NDArray[np.uint32]


@dataclasses.dataclass(eq=False)
class Triangles:
    positions: Floats  #: (vertices, 3)
    normals: Floats    #: (vertices, 3), of length 1
    nodes: Nodes       #: (triangles, 3), counterclockwise as seen from outside


def quads(cloth: Cloth) -> npt.NDArray[np.int64]:
    """Nodes of the faces that are drawn, (faces, 4), counterclockwise with u to the right and v downwards."""
    node = np.arange(cloth.rows * cloth.cols).reshape(cloth.rows, cloth.cols)
    faces = np.stack([node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]], axis=-1).reshape(-1, 4)
    return np.delete(faces, cloth.torn, axis=0)


def normals_of(positions: Array, nodes: Array) -> Floats:
    """Unit normals of vertices: the mean of their triangles', by area; upwards where no triangle has one."""
    a, b, c = (positions[nodes[:, corner]].astype(np.float64) for corner in range(3))
    areas = np.cross(b - a, c - a)
    normals = np.zeros((len(positions), 3))
    for corner in range(3):
        np.add.at(normals, nodes[:, corner], areas)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    unit: Floats = np.where(lengths > 0, normals / np.where(lengths > 0, lengths, 1), [0, 1, 0]).astype(np.float32)
    return unit


def unit_ball() -> Triangles:
    """A ball of radius 1, m, around the origin."""
    return _rounded(1, 0)


def triangles_of(obstacle: Message, surface: typing.Optional[Message] = None) -> typing.Optional[Triangles]:
    """An obstacle in its own axes; None for a plane, which has no end, for shapes that are not known, and meshes without a surface."""
    shape = obstacle["shape"]
    if shape == "box":
        return _box(obstacle["size"])
    if shape == "capsule":
        return _rounded(obstacle["radius"], obstacle["length"])
    if shape in ("mesh", "convex") and surface is not None:
        vertices = np.asarray(surface["vertices"], np.float32).reshape(-1, 3)
        nodes = np.asarray(surface["triangles"], np.uint32).reshape(-1, 3)
        return _flat(vertices, nodes) if shape == "convex" else Triangles(vertices, normals_of(vertices, nodes), nodes)
    return None


def _flat(vertices: Array, nodes: Array) -> Triangles:
    """Each triangle with vertices of its own: edges stay sharp."""
    positions = vertices[nodes.reshape(-1)].astype(np.float32)
    own = np.arange(len(positions), dtype=np.uint32).reshape(-1, 3)
    return Triangles(positions, normals_of(positions, own), own)


def _box(size: typing.Sequence[float]) -> Triangles:
    corners = np.array([[length / 2 if corner >> axis & 1 else -length / 2 for axis, length in enumerate(size)] for corner in range(8)])
    sides = np.array([[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]])
    return _flat(corners, sides[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3))


def _rounded(radius: float, length: float) -> Triangles:
    """A ball, or one whose halves are `length` apart along y: a capsule."""
    upper = [(i * math.pi / (2 * _QUARTER), length / 2) for i in range(_QUARTER + 1)]
    lower = [(math.pi / 2 + i * math.pi / (2 * _QUARTER), -length / 2) for i in range(0 if length > 0 else 1, _QUARTER + 1)]
    polar, centre = np.array(upper + lower).T[:, :, None]  # (rings, 1): angle from the pole, height of the half's centre
    turn = np.arange(_AROUND + 1) * 2 * math.pi / _AROUND
    normals = np.stack(np.broadcast_arrays(np.sin(polar) * np.sin(turn), np.cos(polar), np.sin(polar) * np.cos(turn)), axis=-1)
    positions = radius * normals
    positions[..., 1] += centre
    node = np.arange(positions[..., 0].size).reshape(positions.shape[:2])
    left, right = np.stack([node[:-1, :-1], node[1:, :-1], node[:-1, 1:]], axis=-1), np.stack([node[1:, :-1], node[1:, 1:], node[:-1, 1:]], axis=-1)
    nodes = np.concatenate([left[1:].reshape(-1, 3), right[:-1].reshape(-1, 3)])  # at the poles there is one of the two
    return Triangles(positions.reshape(-1, 3).astype(np.float32), normals.reshape(-1, 3).astype(np.float32), nodes.astype(np.uint32))
