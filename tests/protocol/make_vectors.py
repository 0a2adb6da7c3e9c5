#!/usr/bin/python3
"""Writes protocol/vectors/frames.json, the good and bad frames that all implementations are tested with.

The encoder here is written from PROTOCOL.md alone, as plainly as it can be (bits as text), and shares nothing with the
implementations. tests/protocol/hand_frame.json, computed by hand, checks this one.

make_vectors.py          writes the file
make_vectors.py --check  fails if the file is not what this script writes
"""
import json
import math
import pathlib
import struct
import sys

VECTORS = pathlib.Path(__file__).resolve().parents[2] / "protocol" / "vectors" / "frames.json"
LAST, PAUSED, SLOW = 1, 2, 4


def zigzag(e):
    return 2 * e if e >= 0 else -2 * e - 1


def pack(values, width):
    """Values of `width` bits, least significant bit first."""
    bits = "".join(format(value, f"0{width}b")[::-1] if width else "" for value in values)
    return bytes(int(bits[i:i + 8].ljust(8, "0")[::-1], 2) for i in range(0, len(bits), 8))


def grid_payload(axes, rows, cols, width=None):
    """Codec 1; `axes` holds one flat list of integers each. A given `width` is used for all groups."""
    payload = b""
    for q in axes:
        def at(r, c):
            return q[r * cols + c]
        z = []
        for r in range(rows):
            for c in range(cols):
                if r == 0 and c == 0:
                    predicted = 0
                elif r == 0:
                    predicted = at(r, c - 1)
                elif c == 0:
                    predicted = at(r - 1, c)
                else:
                    predicted = at(r, c - 1) + at(r - 1, c) - at(r - 1, c - 1)
                z.append(zigzag(at(r, c) - predicted))
        for i in range(0, len(z), 16):
            group = z[i:i + 16]
            w = max(group).bit_length() if width is None else width
            payload += bytes([w]) + pack(group, w)
    return payload


def differences(q, rows, cols):
    """Of codec 4."""
    def at(r, c):
        return q[r * cols + c]
    d = {(0, 0): at(0, 0), (0, 1): at(0, 1) - at(0, 0), (1, 0): at(1, 0) - at(0, 0)}
    for c in range(2, cols):
        d[0, c] = at(0, c) - 2 * at(0, c - 1) + at(0, c - 2)
    for r in range(2, rows):
        d[r, 0] = at(r, 0) - 2 * at(r - 1, 0) + at(r - 2, 0)
    for r in range(1, rows):
        for c in range(1, cols):
            d[r, c] = at(r, c) - at(r, c - 1) - at(r - 1, c) + at(r - 1, c - 1)
    return d


def rice_residuals(q, rows, cols):
    """Zig-zagged residuals of codec 4, by (r, c)."""
    d, z = differences(q, rows, cols), {}
    for (r, c), value in d.items():
        expected = 0
        if r >= 2 and 2 <= c <= cols - 2:
            expected = math.floor((6 * d[r - 1, c - 1] + 5 * d[r - 1, c] + 5 * d[r - 1, c + 1] + 8) / 16)
        z[r, c] = zigzag(value - expected)
    return z


def rice_parameter(z, r, c, cols):
    """Of a value of a row beyond the first, from those above it."""
    def near(up, right):
        return z[max(r - up, 0), min(max(c + right, 0), cols - 1)]
    total = (near(1, -2) + 2 * near(1, -1) + 3 * near(1, 0) + 2 * near(1, 1) + near(1, 2)
             + near(2, -1) + 2 * near(2, 0) + near(2, 1) + 3 * near(3, 0))
    return max(math.floor(total / 16).bit_length() - 1, 0)


def rice_code(z, k):
    """Quotient and remainder of a value, as text, first bit first."""
    if z >> k < 20:
        quotient, width = z >> k, k
    else:
        quotient, width = 20, 19
    return "0" * quotient + "1", format(z % 2 ** width, f"0{width}b")[::-1] if width else ""


def rice_payload(axes, rows, cols):
    """Codec 4; `axes` holds one flat list of integers each."""
    planes = [rice_residuals(q, rows, cols) for q in axes]
    first, parts = [], ["", ""]

    def codes(z, r, parameter):
        return [rice_code(z[r, c], parameter(c)) for c in range(cols)]
    for r in range(rows):
        for z in planes:
            if r == 0:
                first.append(min(range(19), key=lambda k: sum(len("".join(code)) for code in codes(z, 0, lambda c: k))))
                row = codes(z, 0, lambda c: first[-1])
            else:
                row = codes(z, r, lambda c: rice_parameter(z, r, c, cols))
            for i in range(2):
                parts[i] += "".join(code[i] for code in row)
    return rice_parts(first, *parts)


def rice_parts(first, quotients, remainders):
    packed = [pack([int(bit) for bit in part], 1) for part in (quotients, remainders)]
    return bytes([*first, 0]) + struct.pack("<I", len(packed[0])) + b"".join(packed)


def record(payload, *, magic=b"WEFT", version=1, kind=1, flags=LAST, header_length=64, codec=1, bits=16, cloth=0, f=120,
           epoch=1, time=2.0, server_ms=4115200, level=5, simulated_level=6, cols=0, rows=0, origin=(0, 0, 0), quantum=1.0,
           payload_length=None):
    length = len(payload) if payload_length is None else payload_length
    head = struct.pack("<4sBBHHBBIIIdIBBHHH3ffI", magic, version, kind, flags, header_length, codec, bits, cloth, f, epoch,
                       time, server_ms, level, simulated_level, 0, cols, rows, *origin, quantum, length)
    assert len(head) == 64
    return head + bytes(range(1, max(0, header_length - 64) + 1)) + payload


class Cloth:
    """A cloth record with what it must decode to."""

    def __init__(self, axes, rows, cols, *, bits=16, origin=(0.0, 0.0, 0.0), quantum=2.0 ** -14, width=None, finest=False, **head):
        # Head has codec=4 where it is to be written by that.
        self.axes, self.rows, self.cols, self.bits, self.origin, self.quantum = axes, rows, cols, bits, origin, quantum
        self.width, self.finest, self.head = width, finest, head
        self.torn = []

    def bytes(self, **more):
        payload = (rice_payload(self.axes, self.rows, self.cols) if self.head.get("codec") == 4
                   else grid_payload(self.axes, self.rows, self.cols, self.width))
        return record(payload, bits=self.bits, cols=self.cols, rows=self.rows,
                      origin=self.origin, quantum=self.quantum, **{**self.head, **more})

    def expected(self):
        positions = [o + value * self.quantum for node in zip(*self.axes) for value, o in zip(node, self.origin)]
        return {"cloth": self.head.get("cloth", 0), "level": self.head.get("level", 5),
                "simulated_level": self.head.get("simulated_level", 6), "rows": self.rows, "cols": self.cols, "bits": self.bits,
                "origin": self.origin, "quantum": self.quantum, "q": self.axes,
                # True: the lattice is the finest that covers these positions, so an encoder must choose it.
                "finest": self.finest,
                "torn": self.torn,
                "positions_f32": struct.pack(f"<{len(positions)}f", *positions).hex()}


def gaps(faces):
    """Ascending face numbers as unsigned LEB128 gaps."""
    payload, before = b"", -1
    for face in faces:
        gap, before = face - before - 1, face
        while gap >= 0x80:
            payload, gap = payload + bytes([gap & 0x7f | 0x80]), gap >> 7
        payload += bytes([gap])
    return payload


def tears_record(mesh, payload, **head):
    fields = {"kind": 4, "codec": 3, "bits": 0, "quantum": 0.0, "rows": mesh.rows, "cols": mesh.cols, **mesh.head}
    return record(payload, **{**fields, **head})


def ball_payload(balls):
    return b"".join(struct.pack("<I3ffI", ident, *position, radius, motion) for ident, position, radius, motion in balls)


def balls_record(balls, **head):
    fields = {"kind": 2, "codec": 2, "bits": 0, "level": 0, "simulated_level": 0, "cols": len(balls), "rows": 1, "quantum": 0.0}
    return record(ball_payload(balls), **{**fields, **head})


def obstacles_record(obstacles, **head):
    payload = b"".join(struct.pack("<I3f4f", index, *position, *quaternion) for index, position, quaternion in obstacles)
    fields = {"kind": 3, "codec": 2, "bits": 0, "level": 0, "simulated_level": 0, "cols": len(obstacles), "rows": 1, "quantum": 0.0}
    return record(payload, **{**fields, **head})


def f32(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def wavy(rows, cols, bits, phase, quantum):
    """A hanging sheet with waves, on the lattice of `quantum` with its corner at the least value of each axis."""
    axes = [[], [], []]
    for r in range(rows):
        for c in range(cols):
            u, v = c / (cols - 1), r / (rows - 1)
            point = (2 * u - 1 + 0.02 * math.sin(7 * v + phase), 1 - 2 * v + 0.01 * math.sin(9 * u),
                     0.3 * math.sin(6 * u + 3 * v + phase) + 0.05 * math.sin(17 * v))
            for axis, value in zip(axes, point):
                axis.append(round(value / quantum))
    least = [min(axis) for axis in axes]
    axes = [[value - low for value in axis] for axis, low in zip(axes, least)]
    assert max(map(max, axes)) < 2 ** bits
    return Cloth(axes, rows, cols, bits=bits, origin=[low * quantum for low in least], quantum=quantum)


def message(name, about, records, expected_cloths=(), expected_balls=(), expected_obstacles=(), **stamp):
    fields = {"f": 120, "epoch": 1, "time": 2.0, "server_ms": 4115200, "flags": 0, **stamp}
    return {"name": name, "about": about, "hex": b"".join(records).hex(),
            "expect": {**fields, "cloths": [cloth.expected() for cloth in expected_cloths],
                       "balls": [{"ball": ident, "position": [f32(x) for x in position], "radius": f32(radius),
                                  "motion": ("kinematic", "dynamic")[motion]} for ident, position, radius, motion in expected_balls],
                       "obstacles": [{"obstacle": index, "position": [f32(x) for x in position], "quaternion": [f32(x) for x in quaternion]}
                                     for index, position, quaternion in expected_obstacles]}}


SMALL = Cloth([[0, 1, 0, 1], [1, 1, 0, 0], [0, 0, 0, 255]], 2, 2, bits=8, quantum=1.0, finest=True)
BALLS = [(1, (0.0, 0.1, 2.5), 0.2, 0), (7, (-3.25, 1e-3, 0.0), 0.05, 1), (4294967295, (1000.0, -1000.0, 0.3), 10.0, 0)]


OBSTACLES = [(0, (0.0, 0.1, 2.5), (1.0, 0.0, 0.0, 0.0)), (63, (-3.25, 1e-3, 1000.0), (0.0, 0.6, 0.0, -0.8))]


def single(name, about, cloth):
    return message(name, about, [cloth.bytes()], [cloth])


def good():
    def made(cloth, **changes):
        cloth.__dict__.update(changes)
        return cloth
    ramp = Cloth([[7 * i % 4096 for i in range(15)], [4095 - 13 * i for i in range(15)], [(i * i * 37) % 4096 for i in range(15)]],
                 3, 5, bits=12, origin=(-0.25, 1.5, -8.0), quantum=2.0 ** -10)
    top = 65535
    upper = Cloth([[top, top - 1, 32768, 32767, 40000, 50000, 60000, 33000, top], [32768] * 9, [top] * 9], 3, 3, origin=(-2.0, -2.0, -2.0))
    # (1, 1) is predicted as 2 * 65535 where it is 0, then as -65535 where it is 65535: the two largest residuals.
    extreme = Cloth([[0, top, top, 0], [top, 0, 0, top], [0, top, 0, top]], 2, 2)
    flat = Cloth([[i % 4 for i in range(20)], [i // 4 for i in range(20)], [0] * 20], 5, 4, bits=8, quantum=2.0 ** -2, origin=(0, 0, 0.75))
    far = Cloth([[0, 1, 2, 65535], [3, 5, 7, 9], [1, 1, 2, 2]], 2, 2, origin=(2.0 ** 20, -2.0 ** 20, 0.0))
    still = Cloth([[0] * 4, [0] * 4, [0] * 4], 2, 2, origin=(0.5, -1.0, 3.0), quantum=2.0 ** -24, finest=True)
    padded = Cloth([[5, 5, 5, 5], [0] * 4, [1, 2, 3, 4]], 2, 2, width=18)
    first, second = wavy(9, 9, 16, 0.7, 2.0 ** -14), wavy(3, 5, 14, 0.1, 2.0 ** -12)
    first.head, second.head = {"cloth": 0, "level": 3, "simulated_level": 3}, {"cloth": 3, "level": 2, "simulated_level": 4}
    torn = made(wavy(9, 9, 16, 0.4, 2.0 ** -14), torn=[0, 1, 8, 62, 63], head={"cloth": 0, "level": 3, "simulated_level": 6})
    example = made(wavy(17, 17, 14, 1.1, 2.0 ** -12), torn=[3, 4, 200])
    return [
        single("small", "2 x 2 on whole metres; computed by hand in tests/protocol/hand_frame.json", SMALL),
        single("ramp", "3 rows of 5: one group of 15, negative origin", ramp),
        single("wavy_9x9", "a hanging sheet at level 3, 16 bits", made(wavy(9, 9, 16, 0.2, 2.0 ** -14), finest=True)),
        single("wavy_17x17", "a hanging sheet at level 4, 14 bits", made(wavy(17, 17, 14, 1.3, 2.0 ** -12), finest=True)),
        single("upper_half", "first values at and above 32768: a 16-bit residual would wrap", upper),
        single("extreme_residuals", "residuals +-131070 and widths of 18", extreme),
        single("flat", "one axis without extent: groups of width 0", flat),
        single("still", "no extent at all: the finest quantum allowed", still),
        single("far", "origin so far that decoding rounds to f32", far),
        single("wide_groups", "groups wider than their values need are read all the same", padded),
        single("rice_2x2", "codec 4 on whole metres, the example of PROTOCOL.md",
               Cloth(SMALL.axes, 2, 2, bits=8, quantum=1.0, codec=4)),
        single("rice_9x9", "codec 4 of a hanging sheet", made(wavy(9, 9, 16, 0.2, 2.0 ** -14), head={"codec": 4}, finest=True)),
        single("rice_17x17", "codec 4 of a hanging sheet", made(wavy(17, 17, 14, 1.3, 2.0 ** -12), head={"codec": 4}, finest=True)),
        single("rice_33x5", "codec 4, more rows than columns", made(wavy(33, 5, 14, 0.6, 2.0 ** -12), head={"codec": 4})),
        single("rice_2x9", "codec 4, two rows", made(wavy(2, 9, 16, 0.6, 2.0 ** -14), head={"codec": 4})),
        single("rice_still", "codec 4 without extent: parameters of 0, no remainders but the first",
               Cloth([[0] * 6, [0] * 6, [7] * 6], 3, 2, quantum=2.0 ** -14, codec=4)),
        single("rice_extremes", "codec 4, values that are written whole, and the largest differences",
               Cloth([[0, 0, 0, 0, 0, 0] * 3 + [0, top, 0, top, 0, top] * 2, [top, 0] * 15, ([0, top, 0, top, 0, top] + [top, 0] * 3) * 2 + [0] * 6],
                     5, 6, codec=4)),
        message("several", "two cloths and three balls of one step",
                [first.bytes(flags=0), second.bytes(flags=0), balls_record(BALLS)], [first, second], BALLS),
        message("balls_only", "a scene without cloth", [balls_record(BALLS[:1])], [], BALLS[:1]),
        message("no_balls", "a list without entries", [balls_record([])]),
        message("obstacles", "a cloth, a ball and two obstacles that moved",
                [SMALL.bytes(flags=0), balls_record(BALLS[:1], flags=0), obstacles_record(OBSTACLES)], [SMALL], BALLS[:1], OBSTACLES),
        message("obstacles_only", "obstacles without cloth or balls", [obstacles_record(OBSTACLES)], expected_obstacles=OBSTACLES),
        message("torn", "a torn cloth and a whole one",
                [torn.bytes(flags=0), tears_record(torn, gaps(torn.torn), flags=0), second.bytes(flags=0), balls_record(BALLS[:1])],
                [torn, second], BALLS[:1]),
        message("torn_last", "the example of codec 3, as the last record",
                [example.bytes(flags=0), tears_record(example, bytes.fromhex("0300c301"))], [example]),
        message("torn_wide", "a gap of three bytes where one would do", [SMALL.bytes(flags=0), tears_record(SMALL, b"\x80\x80\x00")],
                [made(Cloth(SMALL.axes, 2, 2, bits=8, quantum=1.0), torn=[0])]),
        message("unknown_record", "a record of an unknown type, with an unknown codec, is skipped",
                [record(b"\xff" * 13, kind=200, codec=77, bits=99, flags=0), SMALL.bytes()], [SMALL]),
        message("unknown_only", "nothing but an unknown record", [record(b"", kind=5)]),
        message("long_header", "headers of 72 and 256 bytes: what is not known is skipped",
                [SMALL.bytes(header_length=72, flags=0), balls_record(BALLS[:2], header_length=256)], [SMALL], BALLS[:2]),
        message("flags", "paused, slow, and an unknown bit", [SMALL.bytes(flags=LAST | PAUSED | SLOW | 0x8000)], [SMALL],
                flags=PAUSED | SLOW | 0x8000),
        message("stamp", "the largest counters", [SMALL.bytes(f=4294967295, epoch=4294967294, time=71582788.25, server_ms=4294967293)],
                [SMALL], f=4294967295, epoch=4294967294, time=71582788.25, server_ms=4294967293),
    ]


def bad():
    small, payload = SMALL.bytes(), grid_payload(SMALL.axes, 2, 2)
    inf, nan = math.inf, math.nan
    quotients = "quotients that are not as many as values, or too large"
    ball = balls_record(BALLS[:1])

    def cloth(body=payload, **head):
        return record(body, **{"bits": 8, "cols": 2, "rows": 2, **head})

    def rice(body):
        return cloth(body, codec=4)

    def torn_small(body, **head):
        return SMALL.bytes(flags=0) + tears_record(SMALL, body, **head)

    def one_ball(position=(0.0, 0.0, 0.0), radius=1.0, motion=0, **head):
        return balls_record([(1, position, radius, motion)], **head)
    return [
        ("empty", b"", "empty message"),
        ("one_byte", small[:1], "header cut short"),
        ("header_63", small[:63], "header cut short"),
        ("header_only", small[:64], "payload cut short"),
        ("payload_cut", small[:-1], "payload cut short"),
        ("second_header_cut", SMALL.bytes(flags=0) + ball[:40], "header cut short"),
        ("magic", cloth(magic=b"WEFS"), "wrong magic"),
        ("magic_reversed", cloth(magic=b"TFEW"), "wrong magic"),
        ("version_0", cloth(version=0), "version 0"),
        ("version_2", cloth(version=2), "version 2"),
        ("header_length_0", cloth(header_length=0), "header_length 0"),
        ("header_length_7", cloth(header_length=7), "header_length 7"),
        ("header_length_56", cloth(header_length=56), "header_length 56"),
        ("header_length_68", cloth(header_length=68), "header_length 68"),
        ("header_length_264", cloth(header_length=264), "header_length 264"),
        ("header_length_beyond", cloth(b"", header_length=128)[:100], "header cut short"),
        ("payload_length_beyond", cloth(payload_length=11), "payload cut short"),
        ("payload_length_huge", cloth(payload_length=0xffffffff), "payload cut short"),
        ("after_last", small + ball, "bytes after the last record"),
        ("trailing_byte", small + b"\0", "bytes after the last record"),
        ("no_last", cloth(flags=0), "last record is missing"),
        ("other_step", SMALL.bytes(flags=0) + one_ball(f=121), "records of different steps"),
        ("other_epoch", SMALL.bytes(flags=0) + one_ball(epoch=2), "records of different steps"),
        ("time_nan", cloth(time=nan), "time is not finite"),
        ("time_inf", cloth(time=-inf), "time is not finite"),
        ("cloth_codec_2", cloth(codec=2), "codec 2"),
        ("cloth_codec_0", cloth(codec=0), "codec 0"),
        ("bits_7", cloth(bits=7), "7 bits"),
        ("bits_17", cloth(bits=17), "17 bits"),
        ("quantum_0", cloth(quantum=0.0), "unusable origin or quantum"),
        ("quantum_negative", cloth(quantum=-1.0), "unusable origin or quantum"),
        ("quantum_nan", cloth(quantum=nan), "unusable origin or quantum"),
        ("quantum_inf", cloth(quantum=inf), "unusable origin or quantum"),
        ("quantum_3", cloth(quantum=3.0), "unusable origin or quantum"),
        ("quantum_subnormal", cloth(quantum=2.0 ** -130), "unusable origin or quantum"),
        ("quantum_overflow", cloth(quantum=2.0 ** 127), "unusable origin or quantum"),
        ("origin_nan", cloth(origin=(0.0, nan, 0.0)), "unusable origin or quantum"),
        ("origin_inf", cloth(origin=(0.0, 0.0, -inf)), "unusable origin or quantum"),
        ("rows_0", cloth(rows=0), "grid of 0 rows and 2 columns"),
        ("cols_1", cloth(cols=1), "grid of 2 rows and 1 columns"),
        ("cols_1026", cloth(cols=1026), "grid of 2 rows and 1026 columns"),
        ("grid_65535", cloth(rows=65535, cols=65535), "grid of 65535 rows and 65535 columns"),
        ("grid_larger_than_payload", cloth(rows=1025, cols=1025), "grid payload too short"),
        ("payload_empty", cloth(b""), "grid payload too short"),
        ("axis_missing", cloth(bytes.fromhex("0208021209")), "grid payload too short"),
        ("group_cut", cloth(payload[:-1]), "grid payload too short"),
        ("width_19", cloth(bytes([19]) + bytes(20)), "group width 19"),
        ("width_20", cloth(bytes([0, 20]) + bytes(20)), "group width 20"),
        ("width_255", cloth(bytes([0, 0, 255]) + bytes(20)), "group width 255"),
        ("grid_trailing", cloth(payload + b"\0\0"), "2 bytes after the grid payload"),
        # The first residual alone: z = 512 is e = 256, one too many for 8 bits; z = 1 is e = -1.
        ("value_256", cloth(bytes([10]) + pack([512, 511, 0, 0], 10) + b"\0\0"), "value outside 8 bits"),
        ("value_negative", cloth(bytes([1]) + pack([1, 0, 0, 0], 1) + b"\0\0"), "value outside 8 bits"),
        ("rice_empty", rice(b""), "grid payload too short"),
        ("rice_first_parts_only", rice(bytes(9)), "grid payload too short"),
        ("rice_parameter_19", rice(rice_parts([0, 19, 0], "1" * 12, "")), "first parameter 19"),
        ("rice_quotients_beyond", rice(bytes(4) + struct.pack("<I", 3) + b"\xff\x0f"), "grid payload too short"),
        ("rice_quotient_missing", rice(rice_parts([0, 0, 0], "1" * 11, "")), quotients),
        ("rice_quotient_more", rice(rice_parts([0, 0, 0], "1" * 13, "")), quotients),
        ("rice_quotient_21", rice(rice_parts([0, 0, 0], "0" * 21 + "1" * 12, "")), quotients),
        ("rice_quotient_byte_more", rice(rice_parts([0, 0, 0], "1" * 12 + "0" * 8, "")), quotients),
        ("rice_remainders_cut", rice(rice_parts([4, 0, 0], "1" * 12, "")), "grid payload too short"),
        ("rice_remainders_more", rice(rice_parts([0, 0, 0], "1" * 12, "00000000")), "1 bytes after the grid payload"),
        # 2 * 2^18 is the first that is too large; its quotient is 2, its parameter 18.
        ("rice_residual_beyond", rice(rice_parts([18, 0, 0], "001" + "1" * 11, "0" * 36 + "0" * 200)), "residual beyond 19 bits"),
        # 262142 is e = 131071; 12 and 4 of 16 times that give the row below parameters of 17 and 15; of 512, 8 and 7.
        ("rice_difference_beyond", rice(rice_parts([0, 0, 0], "0" * 20 + "1" * 12, format(262142, "019b")[::-1] + "0" * 32)), "difference beyond 131070"),
        ("rice_value_256", rice(rice_parts([0, 0, 0], "0" * 20 + "1" * 12, format(512, "019b")[::-1] + "0" * 15)), "value outside 8 bits"),
        ("rice_value_negative", rice(rice_parts([0, 0, 0], "01" + "1" * 11, "")), "value outside 8 bits"),
        ("cloth_codec_5", cloth(codec=5), "codec 5"),
        ("balls_codec_1", one_ball(codec=1), "codec 1"),
        ("balls_rows_2", one_ball(rows=2), "balls in more than one row"),
        ("balls_count_2", one_ball(cols=2), "balls of another length than their number"),
        ("balls_count_0", one_ball(cols=0), "balls of another length than their number"),
        ("ball_cut", record(ball_payload(BALLS[:1])[:-4], kind=2, codec=2, bits=0, cols=1, rows=1),
         "balls of another length than their number"),
        ("ball_position_nan", one_ball((0.0, nan, 0.0)), "ball is not finite"),
        ("ball_radius_inf", one_ball(radius=inf), "ball is not finite"),
        ("ball_motion_2", one_ball(motion=2), "ball with motion 2"),
        ("tears_codec_2", torn_small(b"\0", codec=2), "codec 2"),
        ("tears_alone", tears_record(SMALL, b"\0"), "tears of no mesh before them"),
        ("tears_other_cloth", torn_small(b"\0", cloth=1), "tears of no mesh before them"),
        ("tears_other_rows", torn_small(b"\0", rows=3), "tears of no mesh before them"),
        ("tears_other_cols", torn_small(b"\0", cols=5), "tears of no mesh before them"),
        ("tears_gap_cut", torn_small(b"\x80"), "unreadable gap between tears"),
        ("tears_gap_of_four", torn_small(b"\x80\x80\x80\x00"), "unreadable gap between tears"),
        ("tears_beyond", torn_small(b"\x01"), "tear beyond the mesh"),
        ("tears_second_beyond", torn_small(b"\0\0"), "tear beyond the mesh"),
        ("obstacles_codec_1", obstacles_record(OBSTACLES, codec=1), "codec 1"),
        ("obstacles_rows_0", obstacles_record(OBSTACLES, rows=0), "obstacles in more than one row"),
        ("obstacles_count_3", obstacles_record(OBSTACLES, cols=3), "obstacles of another length than their number"),
        ("obstacle_position_inf", obstacles_record([(0, (0.0, inf, 0.0), (1.0, 0.0, 0.0, 0.0))]), "obstacle is not finite"),
        ("obstacle_quaternion_nan", obstacles_record([(0, (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, nan))]), "obstacle is not finite"),
    ]


def text():
    lines = {"good": [json.dumps(vector) for vector in good()],
             "bad": [json.dumps({"name": name, "hex": data.hex(), "error": error}) for name, data, error in bad()]}
    return "{\n" + ",\n".join(f'"{part}": [\n' + ",\n".join(items) + "\n]" for part, items in lines.items()) + "\n}\n"


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        if VECTORS.read_text() != text():
            sys.exit(f"{VECTORS} is not what this script writes")
    else:
        VECTORS.write_text(text())
