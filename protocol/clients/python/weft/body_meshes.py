"""Balls and obstacles of a frame, as files show them: their names, where they are, and their triangles there."""
from __future__ import annotations

import math
import typing

import numpy as np

from .surfaces import Triangles, triangles_of, unit_ball
from .types import Array, Frame, Message

Turn = typing.Tuple[float, float, float, float]  #: w, x, y, z
Pose = typing.Tuple[typing.Sequence[float], Turn]
Surfaces = typing.Mapping[int, Message]  #: of those obstacles that are meshes, by their place in the scene
_UPRIGHT: Turn = (1.0, 0.0, 0.0, 0.0)


def ball_name(ball: int) -> str:
    return f"ball-{ball}"


def shapes_of(obstacles: typing.Sequence[Message], surfaces: Surfaces) -> typing.List[typing.Tuple[int, str, Triangles]]:
    """Place in the scene, name and triangles in its own axes of each obstacle that can be drawn: no plane, no mesh without a surface."""
    shapes = ((index, triangles_of(home, surfaces.get(index))) for index, home in enumerate(obstacles))
    return [(index, f"obstacle-{index}", shape) for index, shape in shapes if shape is not None]


def pose_of(index: int, home: Message, frame: Frame) -> Pose:
    """Where an obstacle is in a frame, which tells of those that are not where the scene has them."""
    moved = next((each for each in frame.obstacles if each.obstacle == index), None)
    position, quaternion = (moved.position, moved.quaternion) if moved else (home["position"], home["quaternion"])
    length = math.hypot(*quaternion)  # sent as floats, it is one to seven digits
    w, x, y, z = (part / length for part in quaternion)
    return position, (w, x, y, z)


def bodies_of(frame: Frame, obstacles: typing.Sequence[Message],
              surfaces: Surfaces) -> typing.Iterator[typing.Tuple[str, Triangles]]:
    """Name and triangles in the world of each ball and of each obstacle that can be drawn."""
    for ball in frame.balls:
        yield ball_name(ball.ball), _placed(unit_ball(), (ball.position, _UPRIGHT), ball.radius)
    for index, name, shape in shapes_of(obstacles, surfaces):
        yield name, _placed(shape, pose_of(index, obstacles[index], frame))


def _placed(shape: Triangles, pose: Pose, scale: float = 1) -> Triangles:
    position, turn = pose
    positions = _turned(scale * shape.positions.astype(np.float64), turn) + np.asarray(position, np.float64)
    normals = _turned(shape.normals.astype(np.float64), turn)
    return Triangles(positions.astype(np.float32), normals.astype(np.float32), shape.nodes)


def _turned(vectors: Array, turn: Turn) -> Array:
    """v + 2 (w u + q x u) of each, where u = q x v and q is the quaternion's vector."""
    across = np.cross(turn[1:], vectors)
    turned: Array = vectors + 2 * (turn[0] * across + np.cross(turn[1:], across))
    return turned
