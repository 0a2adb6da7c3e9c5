"""Binary messages: a step as records (PROTOCOL.md section 4)."""
from __future__ import annotations

import math
import struct
import typing

from .errors import malformed
from .grid import decode_grid
from .rice import decode_rice_grid
from .types import Ball, Cloth, Frame, MovedObstacle, Stamp

_HEADER = struct.Struct("<4sBBHHBBIIIdIBBHHH3ffI")
_BALL = struct.Struct("<I4fI")
_OBSTACLE = struct.Struct("<I7f")
_LAST, _PAUSED, _SLOW = 1, 2, 4
_CODECS = {1: (1, 4), 2: (2,), 3: (2,), 4: (3,)}  # of each kind of record


def decode_frame(message: bytes) -> Frame:
    """Decodes one binary message; raises WeftError `bad_frame` on anything malformed."""
    if not message:
        raise malformed("empty message")
    view = memoryview(message)
    frame, last, at = None, False, 0
    while at < len(view):
        if last:
            raise malformed("bytes after the last record")
        if len(view) - at < _HEADER.size:
            raise malformed("header cut short")
        (magic, version, kind, flags, header_length, codec, bits, cloth, f, epoch, time, server_ms, level, simulated_level, _,
         cols, rows, x, y, z, quantum, payload_length) = _HEADER.unpack_from(view, at)
        if magic != b"WEFT":
            raise malformed("wrong magic")
        if version != 1:
            raise malformed(f"version {version}")
        if not 64 <= header_length <= 256 or header_length % 8:
            raise malformed(f"header_length {header_length}")
        if len(view) - at < header_length:
            raise malformed("header cut short")
        if len(view) - at - header_length < payload_length:
            raise malformed("payload cut short")
        last = bool(flags & _LAST)
        if not math.isfinite(time):
            raise malformed("time is not finite")
        if frame is None:
            frame = Frame(Stamp(f, epoch, time, server_ms, bool(flags & _PAUSED), bool(flags & _SLOW)), [], [], [])
        elif (f, epoch) != (frame.stamp.f, frame.stamp.epoch):
            raise malformed("records of different steps")
        if codec not in _CODECS.get(kind, (codec,)):
            raise malformed(f"codec {codec}")
        payload = view[at + header_length:at + header_length + payload_length]
        at += header_length + payload_length
        if kind == 1:
            decode = decode_rice_grid if codec == 4 else decode_grid
            positions = decode(payload, rows, cols, bits, (x, y, z), quantum)
            frame.cloths.append(Cloth(cloth, level, simulated_level, quantum, positions))
        elif kind == 2:
            frame.balls += _decode_balls(payload, rows, cols)
        elif kind == 3:
            frame.obstacles += _decode_obstacles(payload, rows, cols)
        elif kind == 4:
            _decode_tears(payload, cloth, rows, cols, frame.cloths)
        # Other kinds: of a later minor version.
    if frame is None or not last:
        raise malformed("last record is missing")
    return frame


def _decode_tears(payload: memoryview, index: int, rows: int, cols: int, cloths: typing.List[Cloth]) -> None:
    """Codec 3: gaps between the torn faces of a cloth whose record came before."""
    cloth = next((each for each in cloths if each.cloth == index), None)
    if cloth is None or (cloth.rows, cloth.cols) != (rows, cols):
        raise malformed("tears of no mesh before them")
    faces, face, i = (rows - 1) * (cols - 1), -1, 0
    while i < len(payload):
        gap, shift, more = 0, 0, True
        while more:
            if i == len(payload) or shift > 14:
                raise malformed("unreadable gap between tears")
            gap |= (payload[i] & 0x7f) << shift
            more = payload[i] >= 0x80
            i, shift = i + 1, shift + 7
        face += gap + 1
        if face >= faces:
            raise malformed("tear beyond the mesh")
        cloth.torn.append(face)


def _decode_list(payload: memoryview, rows: int, count: int, things: str,
                 item: struct.Struct) -> typing.Iterator[typing.Tuple[typing.Any, ...]]:
    if rows != 1:
        raise malformed(f"{things} in more than one row")
    if len(payload) != count * item.size:
        raise malformed(f"{things} of another length than their number")
    return item.iter_unpack(payload)


def _decode_obstacles(payload: memoryview, rows: int, count: int) -> typing.List[MovedObstacle]:
    obstacles = []
    for index, x, y, z, a, b, c, d in _decode_list(payload, rows, count, "obstacles", _OBSTACLE):
        if not all(map(math.isfinite, (x, y, z, a, b, c, d))):
            raise malformed("obstacle is not finite")
        obstacles.append(MovedObstacle(index, (x, y, z), (a, b, c, d)))
    return obstacles


def _decode_balls(payload: memoryview, rows: int, count: int) -> typing.List[Ball]:
    balls = []
    for ident, x, y, z, radius, motion in _decode_list(payload, rows, count, "balls", _BALL):
        if not all(map(math.isfinite, (x, y, z, radius))):
            raise malformed("ball is not finite")
        if motion > 1:
            raise malformed(f"ball with motion {motion}")
        balls.append(Ball(ident, (x, y, z), radius, "dynamic" if motion else "kinematic"))
    return balls
