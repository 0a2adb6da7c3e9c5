"""A binary glTF 2.0 document with one buffer."""
from __future__ import annotations

import json
import struct
import typing

import numpy as np

from .types import Array

_FLOAT, _UINT32 = 5126, 5125  # glTF's componentType
_KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_Json = typing.Dict[str, typing.Any]


class Glb:
    def __init__(self) -> None:
        self._binary = bytearray()
        self._channels: typing.List[_Json] = []
        self._samplers: typing.List[_Json] = []
        self._json: _Json = {"asset": {"version": "2.0", "generator": "weft-client"}}

    def add(self, values: Array) -> int:
        """An accessor of float32, or of uint32 where `values` are: of a number a row, or of its 2 to 4 columns."""
        whole = values.dtype == np.uint32
        data = values.astype("<u4" if whole else "<f4")
        rows = data.reshape(len(data), -1)
        view = self._push("bufferViews", {"buffer": 0, "byteOffset": len(self._binary), "byteLength": data.nbytes})
        self._binary += data.tobytes()
        return self._push("accessors", {"bufferView": view, "componentType": _UINT32 if whole else _FLOAT, "count": len(rows),
                                        "type": _KINDS[rows.shape[1]], "min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()})

    def add_material(self, material: _Json) -> int:
        return self._push("materials", material)

    def add_mesh(self, mesh: _Json) -> int:
        return self._push("meshes", mesh)

    def add_node(self, node: _Json) -> int:
        return self._push("nodes", node)

    def animate(self, node: int, path: str, interpolation: str, times: Array, values: Array) -> None:
        """`path`: weights, scale, translation or rotation; `times` in s."""
        self._channels.append({"sampler": len(self._samplers), "target": {"node": node, "path": path}})
        self._samplers.append({"input": self.add(times), "output": self.add(values), "interpolation": interpolation})

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

    def _push(self, name: str, entry: _Json) -> int:
        entries: typing.List[_Json] = self._json.setdefault(name, [])
        entries.append(entry)
        return len(entries) - 1
