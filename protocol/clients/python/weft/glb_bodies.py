"""Balls and obstacles of frames as nodes of a .glb that move."""
from __future__ import annotations

import typing

import numpy as np

from .glb import Glb
from .surfaces import Triangles, triangles_of, unit_ball
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
        node = glb.add_node({"name": f"ball-{each}", "mesh": mesh, "translation": places[0].tolist(), "scale": sizes[0].tolist()})
        _animate(glb, node, "translation", "LINEAR", times, places)
        _animate(glb, node, "scale", "STEP", times, sizes)


def add_obstacles(glb: Glb, frames: typing.Sequence[Frame], times: Array, obstacles: typing.Sequence[Message],
                  surfaces: typing.Mapping[int, Message]) -> None:
    """Each as `obstacle-INDEX`, by its place in the scene."""
    for index, home in enumerate(obstacles):
        shape = triangles_of(home, surfaces.get(index))
        if shape is None:
            continue
        moved = [next((each for each in frame.obstacles if each.obstacle == index), None) for frame in frames]
        places = np.array([each.position if each else home["position"] for each in moved])
        turns = np.roll(np.array([each.quaternion if each else home["quaternion"] for each in moved], np.float64), -1, axis=1)  # x, y, z, w
        turns /= np.linalg.norm(turns, axis=1, keepdims=True)  # sent as floats, they are one to seven digits
        name = f"obstacle-{index}"
        node = glb.add_node({"name": name, "mesh": _add_shape(glb, name, shape, _SOLID), "translation": places[0].tolist(),
                             "rotation": turns[0].tolist()})
        _animate(glb, node, "translation", "LINEAR", times, places)
        _animate(glb, node, "rotation", "LINEAR", times, turns)
