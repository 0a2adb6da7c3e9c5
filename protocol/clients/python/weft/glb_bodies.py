"""Balls and obstacles of frames as nodes of a .glb that move."""
from __future__ import annotations

import typing

import numpy as np

from .body_meshes import Surfaces, ball_name, pose_of, shapes_of
from .glb import Glb
from .surfaces import Triangles, unit_ball
from .types import Array, Frame, Message

_BALL, _SOLID = [0.75, 0.11, 0.1, 1], [0.48, 0.44, 0.38, 1]  # linear red, green, blue, opacity


def _add_shape(glb: Glb, name: str, shape: Triangles, colour: typing.List[float]) -> int:
    material = glb.add_material({"name": name, "pbrMetallicRoughness": {"baseColorFactor": colour, "metallicFactor": 0}})
    return glb.add_mesh({"name": name, "primitives": [{
        "attributes": {"POSITION": glb.add(shape.positions), "NORMAL": glb.add(shape.normals)},
        "indices": glb.add(shape.nodes.reshape(-1)), "material": material}]})


def _animate(glb: Glb, node: int, path: str, interpolation: str, times: Array, values: Array) -> None:
    """Of what stands still nothing is written."""
    if (values != values[0]).any():
        glb.animate(node, path, interpolation, times, values)


def add_balls(glb: Glb, frames: typing.Sequence[Frame], times: Array) -> None:
    """Each as `ball-ID`: of no size in frames that do not have it."""
    ids = sorted({ball.ball for frame in frames for ball in frame.balls})
    if not ids:
        return
    mesh = _add_shape(glb, "ball", unit_ball(), _BALL)
    for each in ids:
        shown = [next((ball for ball in frame.balls if ball.ball == each), None) for frame in frames]
        last = next(ball for ball in shown if ball is not None)  # where it is before it comes, and stays when it is gone
        places = np.array([(last := ball or last).position for ball in shown])
        sizes = np.array([[ball.radius if ball else 0.0] * 3 for ball in shown])
        node = glb.add_node({"name": ball_name(each), "mesh": mesh, "translation": places[0].tolist(), "scale": sizes[0].tolist()})
        _animate(glb, node, "translation", "LINEAR", times, places)
        _animate(glb, node, "scale", "STEP", times, sizes)


def add_obstacles(glb: Glb, frames: typing.Sequence[Frame], times: Array, obstacles: typing.Sequence[Message],
                  surfaces: Surfaces) -> None:
    """Each as `obstacle-INDEX`, by its place in the scene."""
    for index, name, shape in shapes_of(obstacles, surfaces):
        poses = [pose_of(index, obstacles[index], frame) for frame in frames]
        places = np.array([position for position, _ in poses])
        turns = np.array([(x, y, z, w) for _, (w, x, y, z) in poses])
        node = glb.add_node({"name": name, "mesh": _add_shape(glb, name, shape, _SOLID), "translation": places[0].tolist(),
                             "rotation": turns[0].tolist()})
        _animate(glb, node, "translation", "LINEAR", times, places)
        _animate(glb, node, "rotation", "LINEAR", times, turns)
