"""Received frames as files: .obj and animated .glb of all that a scene shows, .npz for learning; lengths in m, y up."""
from __future__ import annotations

import itertools
import os
import typing

import numpy as np
import numpy.typing as npt

from .body_meshes import Surfaces, bodies_of
from .glb import Glb
from .glb_bodies import add_balls, add_obstacles
from .surfaces import Floats, Nodes, normals_of, quads
from .types import Array, Cloth, Frame, Message

_LONGEST = 60  # frames that one mesh shows: programs give each of its targets a place on the graphics card
Path = typing.Union[str, "os.PathLike[str]"]


def write_obj(path: Path, frame: Frame, scene: typing.Optional[Message] = None, surfaces: typing.Optional[Surfaces] = None) -> None:
    """An object each cloth, of quads with texture coordinates (u, 1 - v), without those that are torn; then an object each ball and,
    if `scene` (the message, as a client has it) tells of them, each obstacle, planes left out; all with normals. `surfaces`: of
    obstacles that are meshes, as `surface` tells them."""
    lines, before = [], 1  # vertices count from 1 through the file
    for cloth in frame.cloths:
        positions = cloth.positions.reshape(-1, 3)
        u, v = _coordinates(cloth).T
        lines.append(f"o {_name(cloth.cloth, scene)}")
        lines += _obj_lines("v", positions)
        lines += _obj_lines("vt", np.stack([u, 1 - v], axis=-1))
        lines += _obj_lines("vn", normals_of(positions, _triangles(cloth)))
        lines += ["f " + " ".join(f"{node}/{node}/{node}" for node in quad) for quad in (quads(cloth) + before).tolist()]
        before += len(positions)
    for name, shape in bodies_of(frame, _obstacles(scene), surfaces or {}):
        lines.append(f"o {name}")
        lines += _obj_lines("v", shape.positions)
        lines += _obj_lines("vn", shape.normals)
        lines += [f"f {a}//{a} {b}//{b} {c}//{c}" for a, b, c in (shape.nodes.astype(np.int64) + before).tolist()]
        before += len(shape.positions)
    with open(path, "w", encoding="ascii") as out:
        out.write("\n".join(lines) + "\n")


def write_glb(path: Path, frames: typing.Sequence[Frame], scene: typing.Optional[Message] = None,
              surfaces: typing.Optional[Surfaces] = None) -> None:
    """An animation that begins at 0 s. A cloth is a mesh with a morph target a frame: one after another, each of 60 frames at most,
    and another from where its level or its tears change. Balls are nodes that move, and so are obstacles if `scene` (the message,
    as a client has it) tells of them, planes left out; `surfaces`: of those that are meshes, as `surface` tells them. Raises
    ValueError unless there are frames, of one epoch, each later than the one before."""
    times = _times(frames)
    glb = Glb()
    material = glb.add_material({"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0}})
    for index in sorted({cloth.cloth for frame in frames for cloth in frame.cloths}):
        shown = [next((cloth for cloth in frame.cloths if cloth.cloth == index), None) for frame in frames]
        for mesh, group in itertools.groupby(range(len(shown)), lambda i: _mesh(shown[i])):
            span = list(group)
            for begin in range(0, len(span) if mesh else 0, _LONGEST):
                # The next mesh takes over at its own first frame, and this one has to be there by then.
                part = span[begin:begin + _LONGEST + 1]
                end = part[0] + min(len(part), _LONGEST)
                _add_span(glb, _name(index, scene), [shown[i] for i in part], part[0], end, times, material)
    add_balls(glb, frames, times)
    add_obstacles(glb, frames, times, _obstacles(scene), surfaces or {})
    with open(path, "wb") as out:
        out.write(glb.bytes())


def write_npz(path: Path, frames: typing.Sequence[Frame], wind: Array, cloth: int = 0) -> None:
    """A cloth through n frames at one level: `time` (n), s; `positions` and `velocities` (n, rows, cols, 3), m, m/s, the latter by
    differences of second order, at the ends of first; `wind` as given, (3) or (n, 3), m/s, told for each frame; `balls`
    (n, most, 4), x, y, z, radius, m, nan where there are fewer. Raises ValueError as write_glb, for fewer than two frames, another
    shape of `wind`, and where the cloth is missing or its level changes."""
    times = _times(frames)
    if len(frames) < 2:
        raise ValueError("frames has 1; a velocity needs 2 or more")
    meshes = [each for frame in frames for each in frame.cloths if each.cloth == cloth]
    shapes = {each.positions.shape for each in meshes}
    if len(meshes) != len(frames) or len(shapes) != 1:
        raise ValueError(f"cloth {cloth} is in {len(meshes)} of {len(frames)} frames in {len(shapes)} shapes; allowed: in all, in one")
    winds = np.asarray(wind, np.float32)
    if winds.shape not in ((3,), (len(frames), 3)):
        raise ValueError(f"wind has the shape {winds.shape}; allowed: (3,) or ({len(frames)}, 3)")
    positions = np.stack([each.positions for each in meshes])
    balls = np.full((len(frames), max(len(frame.balls) for frame in frames), 4), np.nan, np.float32)
    for i, frame in enumerate(frames):
        for k, ball in enumerate(frame.balls):
            balls[i, k] = (*ball.position, ball.radius)
    velocities = np.gradient(positions.astype(np.float64), times, axis=0).astype(np.float32)
    np.savez_compressed(path, time=times + frames[0].stamp.time, positions=positions, velocities=velocities,
                        wind=np.broadcast_to(winds, (len(frames), 3)), balls=balls)


def _name(cloth: int, scene: typing.Optional[Message]) -> str:
    """As the scene calls it, else by its place."""
    told = next((each.get("name") for each in scene["cloths"] if each["cloth"] == cloth), None) if scene else None
    return told or f"cloth-{cloth}"


def _obstacles(scene: typing.Optional[Message]) -> typing.Sequence[Message]:
    obstacles: typing.Sequence[Message] = scene.get("obstacles", []) if scene else []
    return obstacles


def _triangles(cloth: Cloth) -> Nodes:
    return quads(cloth)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3).astype(np.uint32)


def _coordinates(cloth: Cloth) -> Floats:
    """u, v of each node: from 0 to 1 along its columns and its rows."""
    v, u = np.meshgrid(*(np.linspace(0, 1, count) for count in cloth.positions.shape[:2]), indexing="ij")
    coordinates: Floats = np.stack([u, v], axis=-1).reshape(-1, 2).astype(np.float32)
    return coordinates


def _obj_lines(keyword: str, values: Floats) -> typing.List[str]:
    """Nine digits read back to the same float."""
    return [" ".join([keyword, *(f"{value:.9g}" for value in row)]) for row in values.tolist()]


def _times(frames: typing.Sequence[Frame]) -> npt.NDArray[np.float64]:
    """Since the first frame, s."""
    if not frames:
        raise ValueError("frames is empty; allowed: 1 or more")
    epochs = sorted({frame.stamp.epoch for frame in frames})
    if len(epochs) > 1:
        raise ValueError(f"frames are of epochs {epochs}; allowed: one")
    times = np.array([frame.stamp.time for frame in frames])
    stuck = np.flatnonzero(np.diff(times) <= 0)
    if stuck.size:
        raise ValueError(f"frames[{stuck[0] + 1}] is at {times[stuck[0] + 1]:g} s; allowed: after {times[stuck[0]]:g} s")
    since: npt.NDArray[np.float64] = times - times[0]
    return since


def _mesh(cloth: typing.Optional[Cloth]) -> typing.Optional[typing.Tuple[int, int, typing.Tuple[int, ...]]]:
    """What frames share that one mesh shows; none without a face."""
    if cloth is None or len(cloth.torn) == (cloth.rows - 1) * (cloth.cols - 1):
        return None
    return cloth.rows, cloth.cols, tuple(cloth.torn)


def _add_span(glb: Glb, name: str, shown: typing.Sequence[typing.Optional[Cloth]], begin: int, end: int,
              times: npt.NDArray[np.float64], material: int) -> None:
    """A mesh that is seen from frame `begin` until frame `end`."""
    cloths = [cloth for cloth in shown if cloth is not None]
    triangles = _triangles(cloths[0])
    positions = [cloth.positions.reshape(-1, 3) for cloth in cloths]
    normals = [normals_of(each, triangles) for each in positions]
    primitive: Message = {
        "attributes": {"POSITION": glb.add(positions[0]), "NORMAL": glb.add(normals[0]),
                       "TEXCOORD_0": glb.add(_coordinates(cloths[0]))},
        "indices": glb.add(triangles.reshape(-1)), "material": material}
    mesh: Message = {"name": name, "primitives": [primitive]}
    if len(cloths) > 1:
        primitive["targets"] = [{"POSITION": glb.add(position - positions[0]), "NORMAL": glb.add(normal - normals[0])}
                                for position, normal in zip(positions[1:], normals[1:])]
        mesh["weights"] = [0] * (len(cloths) - 1)
    whole = begin == 0 and end == len(times)
    node = glb.add_node({"name": name if whole else f"{name}-frame-{begin}", "mesh": glb.add_mesh(mesh)})
    if len(cloths) > 1:
        glb.animate(node, "weights", "LINEAR", times[begin:begin + len(cloths)], np.eye(len(cloths))[:, 1:].reshape(-1))
    # Scaled to nothing before and after.
    keys = [(0, 0)] * (begin > 0) + [(begin, 1)] + [(end, 0)] * (end < len(times))
    if len(keys) > 1:
        at, scale = zip(*keys)
        glb.animate(node, "scale", "STEP", times[list(at)], np.repeat(scale, 3).reshape(-1, 3))
