"""RFC 6455 frame by frame: lengths, control frames, reserved bits and opcodes, fragments, UTF-8, closes, masks. The cases are those of
the sections 1 to 7 of the Autobahn test suite (whose echo is here the answer to a `ping` of the protocol), each in one piece, and
in pieces of one byte where it is not long."""
import contextlib
import json
import socket
import unittest

from serving import SCENES, Server, server_frames

CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG = 0, 1, 2, 8, 9, 10
MASK = b"\x37\xfa\x21\x3d"  # of the RFC's own example
LONGEST = 16384             # message_bytes


def frame(opcode, payload=b"", *, final=True, rsv=0, mask=MASK, length=None):
    """A frame as a client sends it. `length`: bytes that the length is written in beside the first seven bits."""
    size = len(payload)
    length = length if length is not None else 0 if size < 126 else 2 if size < 65536 else 8
    first = {0: size, 2: 126, 8: 127}[length]
    head = bytes([(0x80 if final else 0) | rsv << 4 | opcode, (0x80 if mask else 0) | first])
    head += size.to_bytes(length, "big") if length else b""
    if not mask:
        return head + payload
    return head + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))


def fragments(opcode, *parts, between=b""):
    frames = [frame(opcode if i == 0 else CONTINUATION, part, final=i == len(parts) - 1) for i, part in enumerate(parts)]
    return between.join(frames)


def ask(size=0, re=1):
    """A `ping` of the protocol, filled up to a size: its answer is told by its id."""
    text = json.dumps({"op": "ping", "id": re, "t": 0}).encode()
    return text + b" " * (size - len(text))


def close(code, reason=b""):
    return frame(CLOSE, code.to_bytes(2, "big") + reason)


BYE = close(1000)
# A case: its name, what is sent, what is sent once that is answered, and the code that the server closes with, the ids of requests
# that it has answered and the payloads of its pongs.
WELL = BYE, (1000, [1], [])


def lengths():
    for size in [26, 125, 126, 127, 128, 1000, 4096, LONGEST]:
        yield f"text of {size} bytes", frame(TEXT, ask(size)), *WELL
    for size in [LONGEST + 1, 65535, 65536]:
        yield f"text of {size} bytes", frame(TEXT, ask(size)) + BYE, b"", (1009, [], [])
    yield "empty text", frame(TEXT) + frame(TEXT, ask()), BYE, (1000, [1], [])
    for size in [0, 1, 125, 126, 127, 128, 4096]:
        yield f"binary of {size} bytes", frame(BINARY, bytes(size)), b"", (1003, [], [])
    for size, length in [(26, 2), (26, 8), (125, 2), (125, 8), (126, 8), (4096, 8)]:  # 5.2: the fewest bytes that do
        yield f"{size} written in {length} bytes", frame(TEXT, ask(size), length=length) + BYE, b"", (1002, [], [])
    highest = b"\x81\xff" + (1 << 63).to_bytes(8, "big") + MASK  # 5.2: the highest bit is 0
    yield "a length beyond 63 bits", highest + BYE, b"", (1002, [], [])
    yield "a length of 2^62", b"\x81\xff" + (1 << 62).to_bytes(8, "big") + MASK + BYE, b"", (1009, [], [])


def pings():
    for payload in [b"", b"Hello, world!", bytes([0, 255, 254, 253, 252, 251, 0, 255]), b"\xfe" * 124, b"\xfe" * 125]:
        yield f"ping of {len(payload)} bytes", frame(PING, payload) + BYE, b"", (1000, [], [payload])
        yield f"pong of {len(payload)} bytes", frame(PONG, payload) + frame(TEXT, ask()), *WELL
    for opcode in (PING, PONG):
        for size in (126, 127, 4096):  # 5.5: at most 125
            yield f"control frame {opcode} of {size} bytes", frame(opcode, b"\xfe" * size) + BYE, b"", (1002, [], [])
        yield f"control frame {opcode} of 2 in 2 bytes", frame(opcode, b"ab", length=2) + BYE, b"", (1002, [], [])
    yield "a ping after a pong", frame(PONG, b"old") + frame(PING, b"new") + BYE, b"", (1000, [], [b"new"])
    ten = [b"payload-%d" % i for i in range(10)]
    yield "ten pings", b"".join(frame(PING, each) for each in ten) + BYE, b"", (1000, [], ten)


def reserved():
    kinds = [("text", TEXT, ask(re=2)), ("ping", PING, b"x"), ("close", CLOSE, b"\x03\xe8")]
    for rsv in range(1, 8):  # 5.2: no extension is negotiated
        for name, opcode, payload in kinds:
            yield f"{name} with reserved bits {rsv}", frame(TEXT, ask()), frame(opcode, payload, rsv=rsv) + BYE, (1002, [1], [])
        opened = frame(TEXT, ask()[:5], final=False)
        yield f"continuation with reserved bits {rsv}", opened + frame(CONTINUATION, ask()[5:], rsv=rsv) + BYE, b"", (1002, [], [])
    for opcode in [3, 4, 5, 6, 7, 11, 12, 13, 14, 15]:
        yield f"opcode {opcode}", frame(opcode) + BYE, b"", (1002, [], [])
        yield f"opcode {opcode} with a payload", frame(TEXT, ask()), frame(opcode, b"x") + BYE, (1002, [1], [])


def fragmented():
    text = ask()
    half, rest = text[:9], text[9:]
    for opcode in (PING, PONG, CLOSE):  # 5.5: never fragmented
        yield f"fragmented control frame {opcode}", frame(opcode, b"", final=False) + frame(CONTINUATION) + BYE, b"", (1002, [], [])
    for name, parts in [("two", [half, rest]), ("two, one empty", [b"", text]), ("two, the last empty", [text, b""]),
                        ("three, the middle empty", [half, b"", rest]), ("a byte each", [text[i:i + 1] for i in range(len(text))])]:
        yield f"fragments: {name}", fragments(TEXT, *parts), *WELL
    yield "a ping between fragments", fragments(TEXT, half, rest, between=frame(PING, b"p")), BYE, (1000, [1], [b"p"])
    yield "a pong between fragments", fragments(TEXT, half, rest, between=frame(PONG, b"p")), *WELL
    parts = [text[:4], text[4:8], text[8:12], text[12:]]
    yield "pings between fragments", fragments(TEXT, *parts, between=frame(PING, b"p")), BYE, (1000, [1], [b"p"] * 3)
    yield "binary in fragments", fragments(BINARY, b"a", b"b"), b"", (1003, [], [])
    for final in (True, False):  # 5.4
        lone = frame(CONTINUATION, half, final=final)
        yield f"nothing to continue, final {final}", lone + frame(TEXT, ask()) + BYE, b"", (1002, [], [])
        yield f"nothing to continue after a message, final {final}", frame(TEXT, ask()), lone + BYE, (1002, [1], [])
        for name, opcode in [("text", TEXT), ("binary", BINARY)]:
            amidst = frame(TEXT, half, final=False) + frame(opcode, b"x", final=final)
            yield f"{name} amidst a message, final {final}", amidst + BYE, b"", (1002, [], [])
    yield "a close amidst a message", frame(TEXT, half, final=False) + BYE, b"", (1000, [], [])
    yield "many fragments beyond 16 KiB", fragments(TEXT, *[b" " * 1024] * 17) + BYE, b"", (1009, [], [])
    two = fragments(TEXT, half, rest) + fragments(TEXT, ask(re=2)[:7], ask(re=2)[7:])
    yield "two messages in fragments", two, BYE, (1000, [1, 2], [])


def utf8():
    good = ["κόσμε", "\x7f", "\x80", "\u07ff", "\u0800", "\ud7ff", "\ue000", "\ufffd", "\uffff", "\U00010000", "\U0010ffff", "\0"]
    for text in good:  # no JSON, but read
        yield f"UTF-8 {text.encode().hex()}", frame(TEXT, text.encode()) + frame(TEXT, ask()), *WELL
    bad = ["80", "bf", "8080", "c0", "c0af", "c1bf", "e0", "e080", "e080af", "e09fbf", "eda080", "edbfbf", "eda080edb080", "f08080af",
           "f08fbfbf", "f4908080", "f888808080", "fc8480808080", "fe", "ff", "fefeffff", "c3", "c328", "e282", "e28228", "f09d84",
           "f0288cbc", "cebae1bdb9cf83cebcceb5eda080656469746564", "6869ff"]
    for text in bad:
        yield f"bad UTF-8 {text}", frame(TEXT, bytes.fromhex(text)) + BYE, b"", (1007, [], [])
    kosme = "κόσμε".encode()
    for cut in (1, 3, 4):
        yield f"UTF-8 cut at {cut}", fragments(TEXT, kosme[:cut], kosme[cut:]) + frame(TEXT, ask()), *WELL
    yield "UTF-8 a byte each", fragments(TEXT, *[kosme[i:i + 1] for i in range(len(kosme))]) + frame(TEXT, ask()), *WELL
    yield "bad UTF-8 in the second fragment", fragments(TEXT, kosme, b"\xed\xa0\x80") + BYE, b"", (1007, [], [])
    yield "bad UTF-8 in a message without an end", frame(TEXT, kosme + b"\xf4\x90\x80\x80", final=False) + BYE, b"", (1007, [], [])
    yield "a character without an end in fragments", fragments(TEXT, kosme, b"\xf0\x9d") + BYE, b"", (1007, [], [])


def closes():
    yield "close without a code", frame(CLOSE), b"", (1000, [], [])
    yield "close with half a code", frame(CLOSE, b"\x03"), b"", (1002, [], [])
    for code in [1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 3000, 3999, 4000, 4999]:
        yield f"close with {code}", close(code), b"", (code, [], [])
    for code in [0, 999, 1004, 1005, 1006, 1015, 1016, 1100, 2000, 2999, 5000, 65535]:  # 7.4
        yield f"close with {code}", close(code), b"", (1002, [], [])
    yield "a reason", close(1000, b"Hello, world!"), b"", (1000, [], [])
    yield "a reason of 123 bytes", close(1000, b"*" * 123), b"", (1000, [], [])
    yield "a reason of 124 bytes", close(1000, b"*" * 124), b"", (1002, [], [])
    yield "a reason of bad UTF-8", close(1000, b"\xce\xba\xed\xa0\x80"), b"", (1007, [], [])
    yield "a reason cut within a character", close(1000, b"\xce"), b"", (1007, [], [])
    yield "two closes", BYE + close(1001), b"", (1000, [], [])
    yield "a ping after a close", BYE + frame(PING, b"late"), b"", (1000, [], [])
    yield "a message after a close", BYE + frame(TEXT, ask()), b"", (1000, [], [])
    yield "a message and a close", frame(TEXT, ask()), *WELL


def masks():
    # 5.1: what a client sends is masked.
    for name, opcode, payload in [("text", TEXT, ask(re=2)), ("ping", PING, b""), ("close", CLOSE, b"\x03\xe8")]:
        yield f"{name} without a mask", frame(TEXT, ask()), frame(opcode, payload, mask=None) + BYE, (1002, [1], [])
    yield "a mask of zeros", frame(TEXT, ask(), mask=bytes(4)), *WELL


CASES = [case for section in (lengths, pings, reserved, fragmented, utf8, closes, masks) for case in section()]


class Framing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(SCENES / "still.json", "--connections-per-address", 0, "--messages-per-second", 100000)
        cls.addClassCleanup(cls.server.end)

    def outcome(self, first, then, expected, piece):
        connection, status = self.server.raw_socket("/v1/scenes/still")
        self.assertEqual(status, 101)
        with connection:
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            before = b""
            for sent, answers in ((first, expected[1]), (then, [])):
                with contextlib.suppress(OSError):  # closed while it still sends
                    for at in range(0, len(sent), piece):
                        connection.sendall(sent[at:at + piece])
                while answers and before.count(b'"op":"pong"') < len(answers):
                    received = connection.recv(65536)
                    self.assertTrue(received, "closed before it answers")
                    before += received
            frames = list(server_frames(connection, before))
        closes = [payload for opcode, payload in frames if opcode == CLOSE]
        self.assertEqual((len(closes), frames[-1][0]), (1, CLOSE))  # one, and nothing after it
        texts = [json.loads(payload) for opcode, payload in frames if opcode == TEXT]
        answers = [text["re"] for text in texts if text["op"] == "pong"]
        return int.from_bytes(closes[0][:2], "big"), answers, [payload for opcode, payload in frames if opcode == PONG]

    def test_in_one_piece(self):
        for name, first, then, expected in CASES:
            with self.subTest(name):
                self.assertEqual(self.outcome(first, then, expected, len(first + then)), expected)

    def test_in_pieces_of_a_byte(self):
        for name, first, then, expected in CASES:
            if len(first + then) < 200:
                with self.subTest(name):
                    self.assertEqual(self.outcome(first, then, expected, 1), expected)


if __name__ == "__main__":
    unittest.main()
