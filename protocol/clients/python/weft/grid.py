"""The mesh of a cloth in a frame (PROTOCOL.md section 4, codec 1), decoded all values at once."""
from __future__ import annotations

import struct
import typing

import numpy as np
import numpy.typing as npt

from .errors import malformed

GROUP = 16      # values that share a width
MAX_WIDTH = 18  # residuals of 16-bit values, zig-zagged, lie below 2^18
MIN_SIDE, MAX_SIDE = 2, 1025
MAX_FLOAT = 3.4028234663852886e38
#: Beyond the payload: as much as a last group that is full would have, and a whole word.
PADDING = bytes(GROUP * MAX_WIDTH // 8 + 4)


def decode_grid(payload: memoryview, rows: int, cols: int, bits: int, origin: typing.Tuple[float, float, float],
                quantum: float) -> npt.NDArray[np.float32]:
    """Positions (rows, cols, 3), m: three axes of zig-zagged residuals in groups of 16."""
    top = check_grid(rows, cols, bits, origin, quantum)
    residuals, end = _residuals(payload, rows * cols)
    # q - P is d - (d to the left), with d = q - (q above).
    values = residuals.reshape(3, rows, cols).cumsum(axis=2).cumsum(axis=1)
    if values.min() < 0 or values.max() > top:
        raise malformed(f"value outside {bits} bits")
    if end != len(payload):
        raise malformed(f"{len(payload) - end} bytes after the grid payload")
    return positions_of(values, origin, quantum)


def check_grid(rows: int, cols: int, bits: int, origin: typing.Tuple[float, float, float], quantum: float) -> int:
    """The largest value of a grid's lattice, if its header's fields can be a grid's."""
    if not 8 <= bits <= 16:
        raise malformed(f"{bits} bits")
    top = (1 << bits) - 1
    quantum_bits, = struct.unpack("<I", struct.pack("<f", quantum))
    # A positive, normal power of two has neither sign nor fraction bits, and an exponent of neither zeros nor ones.
    usable = not quantum_bits & 0x807fffff and quantum_bits >> 23 not in (0, 255)
    if not usable or not all(abs(value) + quantum * top <= MAX_FLOAT for value in origin):
        raise malformed("unusable origin or quantum")
    if not (MIN_SIDE <= rows <= MAX_SIDE and MIN_SIDE <= cols <= MAX_SIDE):
        raise malformed(f"grid of {rows} rows and {cols} columns")
    return top


def positions_of(values: npt.NDArray[np.int64], origin: typing.Tuple[float, float, float], quantum: float) -> npt.NDArray[np.float32]:
    """Values (3, rows, cols) on the lattice as positions (rows, cols, 3), m."""
    positions = np.array(origin) + values.transpose(1, 2, 0) * quantum
    return np.ascontiguousarray(positions, dtype=np.float32)


def _residuals(payload: memoryview, nodes: int) -> typing.Tuple[npt.NDArray[np.int64], int]:
    """Residuals (3, nodes), and where in the payload they end."""
    starts, widths, end = _groups(payload, nodes)
    padded = bytes(payload) + PADDING
    # The 32 bits that begin at each byte: a value has at most 18, and begins at most 7 into its first byte.
    words: npt.NDArray[np.uint32] = np.ndarray((len(padded) - 3,), "<u4", padded, strides=(1,))
    bit = 8 * starts[:, None] + widths[:, None] * np.arange(GROUP)
    z = (words[bit >> 3] >> (bit & 7)) & ((1 << widths) - 1)[:, None]
    return ((z >> 1) ^ -(z & 1)).reshape(3, -1)[:, :nodes], end


def _groups(payload: memoryview, nodes: int) -> typing.Tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], int]:
    """Where the bits of each group begin, their widths, and where the last group ends: only reading them in turn tells."""
    groups = -(-nodes // GROUP)
    # A group is at least its width byte: no payload buys more memory than it is long.
    if len(payload) < 3 * groups:
        raise malformed("grid payload too short")
    starts, widths, at = [], [], 0
    for _ in range(3):
        for count in [GROUP] * (groups - 1) + [nodes - GROUP * (groups - 1)]:
            if at >= len(payload):
                raise malformed("grid payload too short")
            width = payload[at]
            if width > MAX_WIDTH:
                raise malformed(f"group width {width}")
            starts.append(at + 1)
            widths.append(width)
            at += 1 + (count * width + 7) // 8
    if at > len(payload):
        raise malformed("grid payload too short")
    return np.array(starts, np.int64), np.array(widths, np.int64), at
