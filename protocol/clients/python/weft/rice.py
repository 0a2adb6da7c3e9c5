"""The mesh of a cloth in a frame (PROTOCOL.md section 4, codec 4), decoded a row of all axes at once."""
from __future__ import annotations

import typing

import numpy as np
import numpy.typing as npt

from .errors import malformed
from .grid import check_grid, positions_of

MAX_PARAMETER = 18
ESCAPE = 20         # quotient of a value that is written whole
ESCAPED_WIDTH = 19  # residuals, zig-zagged, lie below 2^19
MAX_DIFFERENCE = 131070
FIRST_PARTS = 8     # parameters of row 0, a byte of zeros, the length of the quotients
Integers = npt.NDArray[np.int64]


def decode_rice_grid(payload: memoryview, rows: int, cols: int, bits: int, origin: typing.Tuple[float, float, float],
                     quantum: float) -> npt.NDArray[np.float32]:
    """Positions (rows, cols, 3), m: Rice codes of zig-zagged residuals, whose parameters follow from the rows before."""
    top = check_grid(rows, cols, bits, origin, quantum)
    # A value is at least the bit that ends its quotient: a payload buys so much memory and no more.
    if len(payload) < FIRST_PARTS + (3 * rows * cols + 7) // 8:
        raise malformed("grid payload too short")
    for parameter in payload[:3]:
        if parameter > MAX_PARAMETER:
            raise malformed(f"first parameter {parameter}")
    end = FIRST_PARTS + int.from_bytes(payload[4:FIRST_PARTS], "little")
    if end > len(payload):
        raise malformed("grid payload too short")
    quotients = _quotients(payload[FIRST_PARTS:end], 3 * rows * cols).reshape(rows, 3, cols)
    residuals = _residuals(payload[end:], quotients, np.array(payload[:3], np.int64))
    values = _values(_differences(residuals))
    if values.min() < 0 or values.max() > top:
        raise malformed(f"value outside {bits} bits")
    return positions_of(values, origin, quantum)


def _quotients(part: memoryview, count: int) -> Integers:
    """Each as so many zeros and a one."""
    ones = np.flatnonzero(np.unpackbits(np.frombuffer(part, np.uint8), bitorder="little"))
    quotients = np.diff(ones, prepend=-1) - 1
    if len(ones) != count or quotients.max() > ESCAPE or len(part) != ones[-1] // 8 + 1:
        raise malformed("quotients that are not as many as values, or too large")
    return quotients


def _residuals(part: memoryview, quotients: Integers, first: Integers) -> Integers:
    """Zig-zagged residuals (rows, 3, cols) from their quotients and the rest of them."""
    rows, _, cols = quotients.shape
    # The 32 bits that begin at each byte: a value has at most 19, and begins at most 7 into its first byte.
    words: npt.NDArray[np.uint32] = np.ndarray((len(part) + 1,), "<u4", bytes(part) + bytes(4), strides=(1,))
    z = np.empty_like(quotients)
    parameters, at = np.repeat(first[:, None], cols, axis=1), 0
    for r in range(rows):
        if r > 0:
            parameters = _parameters(z[r - 1], z[max(r - 2, 0)], z[max(r - 3, 0)])
        escaped = quotients[r] == ESCAPE
        widths = np.where(escaped, ESCAPED_WIDTH, parameters)
        ends = at + widths.ravel().cumsum().reshape(widths.shape)
        at = int(ends[-1, -1])
        if at > 8 * len(part):
            raise malformed("grid payload too short")
        starts = ends - widths
        z[r] = (words[starts >> 3] >> (starts & 7)) & ((1 << widths) - 1) | np.where(escaped, 0, quotients[r] << widths)
        if z[r].max() >= 1 << ESCAPED_WIDTH:
            raise malformed("residual beyond 19 bits")
    unread = len(part) - (at + 7) // 8
    if unread:
        raise malformed(f"{unread} bytes after the grid payload")
    return z


def _parameters(one: Integers, two: Integers, three: Integers) -> Integers:
    """Of a row, from the residuals of those above it, the nearest first: the exponent of the power of two at or below the mean."""
    near, far = np.pad(one, ((0, 0), (2, 2)), "edge"), np.pad(two, ((0, 0), (1, 1)), "edge")
    sums = (near[:, :-4] + 2 * near[:, 1:-3] + 3 * one + 2 * near[:, 3:-1] + near[:, 4:] + far[:, :-2] + 2 * two + far[:, 2:] + 3 * three)
    exponents: Integers = np.frexp(np.maximum(sums >> 4, 1).astype(float))[1].astype(np.int64)
    return exponents - 1


def _differences(z: Integers) -> Integers:
    """Differences (rows, 3, cols): residuals, and what was expected from the row above."""
    differences = (z >> 1) ^ -(z & 1)
    for above, here in zip(differences[1:], differences[2:]):
        here[:, 2:-1] += (6 * above[:, 1:-2] + 5 * above[:, 2:-1] + 5 * above[:, 3:] + 8) >> 4
    if np.abs(differences).max() > MAX_DIFFERENCE:
        raise malformed("difference beyond 131070")
    return differences


def _values(differences: Integers) -> Integers:
    """Values (3, rows, cols): sums of the differences, along row 0 and column 0 those of sums."""
    sums = differences.transpose(1, 0, 2).copy()
    first = sums[:, 0, :1].copy()
    sums[:, 0, 0] = 0
    sums[:, 0] = first + sums[:, 0].cumsum(axis=1).cumsum(axis=1)
    sums[:, 1:, 0] = sums[:, 1:, 0].cumsum(axis=1)
    sums[:, 1:] = sums[:, 1:].cumsum(axis=2)
    return sums.cumsum(axis=1)
