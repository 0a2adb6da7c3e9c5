"""Received frames as files: Wavefront .obj, animated .glb (glTF 2.0), .npz for learning. Cloths alone are drawn; lengths in m, y up."""
from __future__ import annotations

import itertools
import json
import os
import struct
import typing

import numpy as np
import numpy.typing as npt

from .types import Array, Cloth, Frame

_FLOAT, _UINT32 = 5126, 5125  # glTF's componentType
Path = typing.Union[str, "os.PathLike[str]"]
_Json = typing.Dict[str, typing.Any]


def write_obj(path: Path, frame: Frame) -> None:
    """One object `cloth-INDEX` a cloth, quads, torn faces left out."""
    lines, before = [], 1  # vertices count from 1 through the file
    for cloth in frame.cloths:
        lines.append(f"o cloth-{cloth.cloth}")
        lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in cloth.positions.reshape(-1, 3).tolist()]
        lines += [f"f {a} {b} {c} {d}" for a, b, c, d in (_quads(cloth) + before).tolist()]
        before += cloth.rows * cloth.cols
    with open(path, "w", encoding="ascii") as out:
        out.write("\n".join(lines) + "\n")


def write_glb(path: Path, frames: typing.Sequence[Frame]) -> None:
    """An animation that begins at 0 s: each cloth is a mesh with a morph target a frame, and another from where its level or its
    tears change. Raises ValueError unless there are frames, of one epoch, each later than the one before."""
    times = _times(frames)
    glb = _Glb()
    for index in sorted({cloth.cloth for frame in frames for cloth in frame.cloths}):
        shown = [next((cloth for cloth in frame.cloths if cloth.cloth == index), None) for frame in frames]
        for mesh, span in itertools.groupby(range(len(shown)), lambda i: _mesh(shown[i])):
            if mesh is not None:
                _add_span(glb, index, shown, list(span), times)
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


def _quads(cloth: Cloth) -> npt.NDArray[np.int64]:
    """Nodes of the faces that are drawn, (faces, 4), counterclockwise with u to the right and v downwards."""
    node = np.arange(cloth.rows * cloth.cols).reshape(cloth.rows, cloth.cols)
    quads = np.stack([node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]], axis=-1).reshape(-1, 4)
    return np.delete(quads, cloth.torn, axis=0)


def _mesh(cloth: typing.Optional[Cloth]) -> typing.Optional[typing.Tuple[int, int, typing.Tuple[int, ...]]]:
    """What frames share that one mesh shows; none without a face."""
    if cloth is None or len(cloth.torn) == (cloth.rows - 1) * (cloth.cols - 1):
        return None
    return cloth.rows, cloth.cols, tuple(cloth.torn)


def _add_span(glb: _Glb, index: int, shown: typing.Sequence[typing.Optional[Cloth]], span: typing.List[int],
              times: npt.NDArray[np.float64]) -> None:
    cloths = [cloth for cloth in (shown[i] for i in span) if cloth is not None]
    first = cloths[0].positions.reshape(-1, 3)
    triangles = _quads(cloths[0])[:, [0, 1, 2, 0, 2, 3]].reshape(-1)
    primitive: _Json = {"attributes": {"POSITION": glb.add(first, "VEC3")}, "indices": glb.add(triangles.astype("<u4"), "SCALAR"),
                        "material": 0}
    mesh: _Json = {"primitives": [primitive]}
    if len(cloths) > 1:
        primitive["targets"] = [{"POSITION": glb.add(cloth.positions.reshape(-1, 3) - first, "VEC3")} for cloth in cloths[1:]]
        mesh["weights"] = [0] * (len(cloths) - 1)
    node = glb.add_node(f"cloth-{index}-frame-{span[0]}", mesh)
    if len(cloths) > 1:
        glb.animate(node, "weights", "LINEAR", times[span], np.eye(len(cloths))[:, 1:].reshape(-1), "SCALAR")
    # Scaled to nothing before and after.
    keys = [(0, 0)] * (span[0] > 0) + [(span[0], 1)] + [(span[-1] + 1, 0)] * (span[-1] + 1 < len(times))
    if len(keys) > 1:
        at, scale = zip(*keys)
        glb.animate(node, "scale", "STEP", times[list(at)], np.repeat(scale, 3).reshape(-1, 3), "VEC3")


class _Glb:
    """A document and its one buffer."""

    def __init__(self) -> None:
        self._binary = bytearray()
        self._channels: typing.List[_Json] = []
        self._samplers: typing.List[_Json] = []
        material = {"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0}}
        self._json: _Json = {"asset": {"version": "2.0", "generator": "weft-client"}, "materials": [material]}

    def add(self, values: Array, kind: str) -> int:
        """An accessor of float32, or of uint32 where `values` are."""
        data = values if values.dtype == np.dtype("<u4") else values.astype("<f4")
        rows = data.reshape(len(data), -1)
        views, accessors = (self._json.setdefault(name, []) for name in ("bufferViews", "accessors"))
        views.append({"buffer": 0, "byteOffset": len(self._binary), "byteLength": data.nbytes})
        accessors.append({"bufferView": len(views) - 1, "componentType": _UINT32 if data.dtype == np.dtype("<u4") else _FLOAT,
                          "count": len(rows), "type": kind, "min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()})
        self._binary += data.tobytes()
        return len(accessors) - 1

    def add_node(self, name: str, mesh: _Json) -> int:
        meshes, nodes = (self._json.setdefault(name, []) for name in ("meshes", "nodes"))
        meshes.append({"name": name, **mesh})
        nodes.append({"name": name, "mesh": len(meshes) - 1})
        return len(nodes) - 1

    def animate(self, node: int, what: str, interpolation: str, times: Array, values: Array, kind: str) -> None:
        self._channels.append({"sampler": len(self._samplers), "target": {"node": node, "path": what}})
        self._samplers.append({"input": self.add(times, "SCALAR"), "output": self.add(values, kind), "interpolation": interpolation})

    def bytes(self) -> bytes:
        document = dict(self._json, scene=0, scenes=[{"nodes": list(range(len(self._json["nodes"])))}] if "nodes" in self._json else [{}])
        if self._binary:
            document["buffers"] = [{"byteLength": len(self._binary)}]
        if self._channels:
            document["animations"] = [{"channels": self._channels, "samplers": self._samplers}]
        text = json.dumps(document, separators=(",", ":")).encode("ascii")
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        if self._binary:
            chunks += struct.pack("<I4s", len(self._binary), b"BIN\0") + self._binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
