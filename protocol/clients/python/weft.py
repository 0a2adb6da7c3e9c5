"""Weft client: the protocol of PROTOCOL.md (weft.v1) for Python 3.9 and later, on asyncio and the package websockets (10.4).

    import asyncio, weft

    async def main():
        async with await weft.connect("ws://127.0.0.1:8080/v1/scenes/flag") as scene:
            await scene.camera(distance=5)
            ball = await scene.add_ball([0, 1, 2], radius=0.2)
            await scene.throw_ball(ball, [0, 0, -6])
            async for frame in scene:                      # the newest one each time
                print(frame.stamp.f, frame.cloths[0].level, frame.cloths[0].at(0, 0))

    asyncio.run(main())
"""
import array
import asyncio
import contextlib
import dataclasses
import json
import math
import random
import ssl
import struct
import sys
import typing
import urllib.error
import urllib.parse
import urllib.request

try:
    import websockets
except ImportError as missing:
    raise ImportError(
        f"weft needs the package websockets, which {sys.executable} does not have: apt-get install python3-websockets and use "
        "/usr/bin/python3, or pip install websockets") from missing

SUBPROTOCOL = "weft.v1"
Vector = typing.Sequence[float]  #: x, y, z
Turn = typing.Sequence[float]    #: w, x, y, z
MAX_MESSAGE_BYTES = 64 * 1024 * 1024  # of the server's messages: far beyond any scene


class WeftError(Exception):
    """A request refused by the server, a malformed frame, or a connection that failed.

    `code` is one of PROTOCOL.md's, or `bad_frame`, `closed`, `timeout`, `connect`; `path` a JSON pointer into the request.
    """

    def __init__(self, code: str, message: str, path: str = ""):
        super().__init__(message)
        self.code, self.message, self.path = code, message, path


# --- Frames (PROTOCOL.md section 4) ---

_HEADER = struct.Struct("<4sBBHHBBIIIdIBBHHH3ffI")
_BALL = struct.Struct("<I4fI")
_OBSTACLE = struct.Struct("<I7f")
_LAST, _PAUSED, _SLOW = 1, 2, 4
_GROUP = 16      # values that share a width
_MAX_WIDTH = 18  # residuals of 16-bit values, zig-zagged, lie below 2^18
_MAX_FLOAT = 3.4028234663852886e38


@dataclasses.dataclass
class Stamp:
    f: int           #: steps since the epoch began
    epoch: int       #: +1 at each reset
    time: float      #: simulated, s
    server_ms: int   #: the server's monotonic clock, ms, modulo 2^32
    paused: bool
    slow: bool       #: the scene's clock runs behind real time


@dataclasses.dataclass
class Cloth:
    cloth: int              #: index in the scene
    level: int              #: of this mesh
    simulated_level: int    #: level at which the cloth is simulated
    rows: int               #: nodes along v
    cols: int               #: nodes along u
    quantum: float          #: m; positions are exact to half of it
    positions: array.array  #: float32: x, y, z interleaved, row by row, m
    #: faces not to be drawn, ascending: row * (cols - 1) + col is the cell right of and below node (row, col)
    torn: typing.List[int] = dataclasses.field(default_factory=list)

    def at(self, row: int, col: int) -> typing.Tuple[float, float, float]:
        """Position of a node, m."""
        i = 3 * (row * self.cols + col)
        return tuple(self.positions[i:i + 3])


@dataclasses.dataclass
class Ball:
    ball: int
    position: typing.Tuple[float, float, float]
    radius: float
    motion: str  #: "kinematic" or "dynamic"


@dataclasses.dataclass
class MovedObstacle:
    obstacle: int  #: its place in the `scene` message
    position: typing.Tuple[float, float, float]
    quaternion: typing.Tuple[float, float, float, float]  #: w, x, y, z


@dataclasses.dataclass
class Frame:
    stamp: Stamp
    cloths: typing.List[Cloth]
    balls: typing.List[Ball]
    obstacles: typing.List[MovedObstacle]  #: those that are not where `scene` says


def _malformed(reason: str) -> WeftError:
    return WeftError("bad_frame", reason)


def decode_frame(message: bytes) -> Frame:
    """Decodes one binary message; raises WeftError `bad_frame` on anything malformed."""
    if not message:
        raise _malformed("empty message")
    frame, last, at = None, False, 0
    while at < len(message):
        if last:
            raise _malformed("bytes after the last record")
        if len(message) - at < _HEADER.size:
            raise _malformed("header cut short")
        (magic, version, kind, flags, header_length, codec, bits, cloth, f, epoch, time, server_ms, level, simulated_level, _,
         cols, rows, x, y, z, quantum, payload_length) = _HEADER.unpack_from(message, at)
        if magic != b"WEFT":
            raise _malformed("wrong magic")
        if version != 1:
            raise _malformed(f"version {version}")
        if not 64 <= header_length <= 256 or header_length % 8:
            raise _malformed(f"header_length {header_length}")
        if len(message) - at < header_length:
            raise _malformed("header cut short")
        if len(message) - at - header_length < payload_length:
            raise _malformed("payload cut short")
        last = bool(flags & _LAST)
        if not math.isfinite(time):
            raise _malformed("time is not finite")
        if frame is None:
            frame = Frame(Stamp(f, epoch, time, server_ms, bool(flags & _PAUSED), bool(flags & _SLOW)), [], [], [])
        elif (f, epoch) != (frame.stamp.f, frame.stamp.epoch):
            raise _malformed("records of different steps")
        end = at + header_length + payload_length
        payload = message[at + header_length:end]
        at = end
        if kind == 1:
            if codec != 1:
                raise _malformed(f"codec {codec}")
            positions = _decode_grid(payload, rows, cols, bits, (x, y, z), quantum)
            frame.cloths.append(Cloth(cloth, level, simulated_level, rows, cols, quantum, positions))
        elif kind in (2, 3):
            if codec != 2:
                raise _malformed(f"codec {codec}")
            if kind == 2:
                frame.balls += _decode_balls(payload, rows, cols)
            else:
                frame.obstacles += _decode_obstacles(payload, rows, cols)
        elif kind == 4:
            if codec != 3:
                raise _malformed(f"codec {codec}")
            _decode_tears(payload, cloth, rows, cols, frame.cloths)
        # Other kinds: of a later minor version.
    if not last:
        raise _malformed("last record is missing")
    return frame


def _decode_tears(payload, index, rows, cols, cloths) -> None:
    """Codec 3: gaps between the torn faces of a cloth whose record came before."""
    cloth = next((each for each in cloths if each.cloth == index), None)
    if cloth is None or (cloth.rows, cloth.cols) != (rows, cols):
        raise _malformed("tears of no mesh before them")
    faces, face, i = (rows - 1) * (cols - 1), -1, 0
    while i < len(payload):
        gap, shift, more = 0, 0, True
        while more:
            if i == len(payload) or shift > 14:
                raise _malformed("unreadable gap between tears")
            gap |= (payload[i] & 0x7f) << shift
            more = payload[i] >= 0x80
            i, shift = i + 1, shift + 7
        face += gap + 1
        if face >= faces:
            raise _malformed("tear beyond the mesh")
        cloth.torn.append(face)


def _decode_grid(payload, rows, cols, bits, origin, quantum) -> array.array:
    """Codec 1: three axes of zig-zagged residuals in groups of 16."""
    if not 8 <= bits <= 16:
        raise _malformed(f"{bits} bits")
    top = (1 << bits) - 1
    quantum_bits, = struct.unpack("<I", struct.pack("<f", quantum))
    # A positive, normal power of two has neither sign nor fraction bits, and an exponent of neither zeros nor ones.
    usable = not quantum_bits & 0x807fffff and quantum_bits >> 23 not in (0, 255)
    if not usable or not all(abs(value) + quantum * top <= _MAX_FLOAT for value in origin):
        raise _malformed("unusable origin or quantum")
    if not (2 <= rows <= 1025 and 2 <= cols <= 1025):
        raise _malformed(f"grid of {rows} rows and {cols} columns")
    nodes = rows * cols
    # A group is at least its width byte: no payload buys more memory than it is long.
    if len(payload) < 3 * -(-nodes // _GROUP):
        raise _malformed("grid payload too short")
    positions = array.array("f", bytes(12 * nodes))
    at = 0
    for axis, start in enumerate(origin):
        residuals = []
        for first in range(0, nodes, _GROUP):
            if at == len(payload):
                raise _malformed("grid payload too short")
            width = payload[at]
            if width > _MAX_WIDTH:
                raise _malformed(f"group width {width}")
            count = min(_GROUP, nodes - first)
            end = at + 1 + (count * width + 7) // 8
            if end > len(payload):
                raise _malformed("grid payload too short")
            packed, mask = int.from_bytes(payload[at + 1:end], "little"), (1 << width) - 1
            for shift in range(0, count * width, width) if width else (0,) * count:
                z = packed >> shift & mask
                residuals.append(z >> 1 ^ -(z & 1))
            at = end
        decoded, above = [], [0] * cols
        for first in range(0, nodes, cols):
            # q - P is d - (d to the left), with d = q - (q above).
            difference, row = 0, []
            for residual, q in zip(residuals[first:first + cols], above):
                difference += residual
                row.append(q + difference)
            if min(row) < 0 or max(row) > top:
                raise _malformed(f"value outside {bits} bits")
            decoded += row
            above = row
        positions[axis::3] = array.array("f", [start + q * quantum for q in decoded])
    if at != len(payload):
        raise _malformed(f"{len(payload) - at} bytes after the grid payload")
    return positions


def _decode_list(payload, rows, count, things, item):
    if rows != 1:
        raise _malformed(f"{things} in more than one row")
    if len(payload) != count * item.size:
        raise _malformed(f"{things} of another length than their number")
    return item.iter_unpack(payload)


def _decode_obstacles(payload, rows, count) -> typing.List[MovedObstacle]:
    obstacles = []
    for index, *numbers in _decode_list(payload, rows, count, "obstacles", _OBSTACLE):
        if not all(map(math.isfinite, numbers)):
            raise _malformed("obstacle is not finite")
        obstacles.append(MovedObstacle(index, tuple(numbers[:3]), tuple(numbers[3:])))
    return obstacles


def _decode_balls(payload, rows, count) -> typing.List[Ball]:
    balls = []
    for ident, x, y, z, radius, motion in _decode_list(payload, rows, count, "balls", _BALL):
        if not all(map(math.isfinite, (x, y, z, radius))):
            raise _malformed("ball is not finite")
        if motion > 1:
            raise _malformed(f"ball with motion {motion}")
        balls.append(Ball(ident, (x, y, z), radius, "dynamic" if motion else "kinematic"))
    return balls


# --- Control messages (PROTOCOL.md sections 2 and 3) ---

def message_text(op: str, members: typing.Optional[dict] = None, id: typing.Optional[int] = None) -> str:
    """A client message as JSON text: op, id, then the members that are not None."""
    message = {"op": op, "id": id, **(members or {})}
    try:
        return json.dumps({name: value for name, value in message.items() if value is not None}, allow_nan=False)
    except ValueError as error:
        raise WeftError("range", f"{op} has a number that is not finite") from error


# --- The client ---

async def connect(url: str, *, client: typing.Optional[str] = None, window: int = 2, timeout: float = 5.0,
                  on_message: typing.Optional[typing.Callable[[dict], None]] = None, token: typing.Optional[str] = None,
                  tls: typing.Optional[ssl.SSLContext] = None, reconnect: bool = False) -> "Client":
    """Connects to a scene, ws://HOST:PORT/v1/scenes/NAME or wss://: done when the server has greeted, described the scene, and agreed
    on the flow of frames.

    client      name told to the server
    window      unacknowledged frames, 1..8, beside those that the way has room for; 0: no flow control, the server sends as fast as it can
    timeout     s to wait for the connection, and for each reply
    on_message  called with each message that answers no request: `welcome`, `scene`, `event`, `stats`, `curve`,
                `notice`, `error`
    token       the server's, where it asks for one
    tls         whom to trust with wss://, as ssl.create_default_context(cafile=...); without one whom this machine trusts
    reconnect   when the connection breaks it is made again, tried after 0.25, 0.5, 1 s and so on to 10 s, until `close`: at the same
                camera, with what this client held if that is within 5 s. Frames go on; what is sent meanwhile fails with code `closed`
    """
    hello = {"client": client, "caps": ["flow.ack"] if window else [], "window": window or None} if window or client else None
    connection = Client(url, timeout, on_message, token, tls, hello, reconnect)
    try:
        await connection._open()
    except WeftError:
        await connection.close()
        raise
    return connection


def backoff(attempt: int, random: typing.Callable[[], float] = random.random) -> float:
    """s to wait before the attempt, counted from 0: doubled from 0.25 to 10, less up to half of it by chance."""
    return min(10.0, 0.25 * 2.0 ** min(attempt, 10)) * (0.5 + 0.5 * random())


class Client:
    """A connection to one scene. Made by `connect`; iterate over it for frames."""

    def __init__(self, url: str, timeout: float, on_message: typing.Optional[typing.Callable[[dict], None]],
                 token: typing.Optional[str] = None, tls: typing.Optional[ssl.SSLContext] = None,
                 hello: typing.Optional[dict] = None, reconnect: bool = False):
        self.welcome: typing.Optional[dict] = None  #: the server's `welcome`
        self.scene: typing.Optional[dict] = None    #: the newest `scene` message
        self.stats: typing.Optional[dict] = None    #: the newest `stats` message
        self._url, self._hello, self._reconnect = url, hello, reconnect
        self._timeout, self._on_message = timeout, on_message
        self._headers, self._tls = {"Authorization": f"Bearer {token}"} if token else {}, tls
        self._socket = None
        self._reader: typing.Optional[asyncio.Task] = None
        self._acks = False
        self._closing = False
        self._lost: typing.Optional[WeftError] = None
        self._quickest_ping, self._clock_offset_ms = math.inf, math.nan
        self._next_id = 1
        self._requests: typing.Dict[int, asyncio.Future] = {}
        self._newest: typing.Optional[bytes] = None
        self._news = asyncio.Event()  # a frame has come, or the connection has ended
        self._greeted = asyncio.Event()
        self._returning: typing.Optional[asyncio.Task] = None  # while the connection is made again
        self._camera: typing.Optional[dict] = None  # as it was told last
        self._greeted_once = False
        self._before: typing.Optional[dict] = None  # the `scene` before the connection broke
        self._held: typing.Set[int] = set()         # ids of grabs that this client has not let go of

    async def _open(self):
        """Connects: greeted, the scene described, `hello` answered, and where it was before as far as that can be."""
        self._before = self.scene or self._before
        self.welcome, self.scene, self._lost, self._acks = None, None, None, False
        self._quickest_ping, self._clock_offset_ms = math.inf, math.nan
        self._greeted.clear()
        try:
            await asyncio.wait_for(self._greet(), self._timeout)
        except asyncio.TimeoutError:
            raise WeftError("timeout", f"no connection to {self._url} within {self._timeout} s") from None
        except (OSError, websockets.WebSocketException) as error:
            raise WeftError("connect", f"no connection to {self._url}: {error}") from error
        if self._hello:
            await self.send("hello", **self._hello)
        if self._camera:
            with contextlib.suppress(WeftError):  # refused then, it is refused now
                await self.send("camera", **self._camera)
        before, self._before = self._before, None
        if self._held and before and before.get("seat") and before["name"] == self.scene["name"]:
            await self._resume(before["seat"])

    async def _greet(self):
        # The server negotiates no compression; saying so spares the offer.
        secure = {"ssl": self._tls} if self._tls and self._url.startswith("wss:") else {}
        self._socket = await websockets.connect(self._url, subprotocols=[SUBPROTOCOL], compression=None, max_size=MAX_MESSAGE_BYTES,
                                                open_timeout=None, extra_headers=self._headers, **secure)
        self._reader = asyncio.create_task(self._read())
        await self._greeted.wait()
        if self._lost:
            raise self._lost

    async def _resume(self, seat):
        """Takes over what this client held before its connection broke, and lets go of what it let go of meanwhile."""
        try:
            grabs = set((await self.resume_seat(seat))["grabs"])
        except WeftError:  # too late: all is released
            grabs = set()
        for grab in grabs - self._held:
            await self.post("grab.release", grab=grab)
        self._held &= grabs

    async def _return(self):
        """Connects again, as often as it takes."""
        attempt = 0
        while not self._closing:
            await asyncio.sleep(backoff(attempt))
            attempt += 1
            try:
                return await self._open()
            except WeftError:
                if self._socket is not None:
                    await self._socket.close()

    async def _read(self):
        """Takes everything in as it comes, so that nothing queues: replies to their requests, frames to the newest."""
        error = None
        try:
            async for message in self._socket:
                if isinstance(message, bytes):
                    self._newest = message
                    self._news.set()
                else:
                    self._receive(json.loads(message))
        except websockets.ConnectionClosed:
            pass
        except Exception as failure:  # of on_message, or a server that does not speak the protocol
            error = WeftError("closed", f"reading stopped: {failure!r}")
            await self._socket.close(1002 if isinstance(failure, ValueError) else 1000)
        code, reason = self._socket.close_code, self._socket.close_reason
        self._lost = error or WeftError("closed", f"connection closed with {code}{': ' + reason if reason else ''}")
        for future in self._requests.values():
            if not future.done():
                future.set_exception(self._lost)
        self._news.set()
        self._greeted.set()
        returning = self._returning is not None and not self._returning.done()
        if self._reconnect and not self._closing and error is None and not returning and self._greeted_once:
            self._returning = asyncio.create_task(self._return())

    def _receive(self, message):
        op = message.get("op")
        # Noted here and not where `hello` is awaited: a frame may be taken before that code runs.
        if op == "ok" and "caps" in message:
            self._acks = "flow.ack" in message["caps"]
        future = self._requests.get(message.get("re"))
        if future is not None:
            if future.done():
                return
            if op == "error":
                future.set_exception(WeftError(message["code"], message["message"], message.get("path", "")))
            else:
                future.set_result(message)
            return
        if op == "event" and message["kind"] == "reset":
            self._held.clear()
        if op in ("welcome", "scene", "stats"):
            setattr(self, op, message)
        if self.welcome and self.scene:
            self._greeted_once = True
            self._greeted.set()
        if self._on_message:
            self._on_message(message)

    async def _write(self, text):
        if self._lost:
            raise self._lost
        try:
            await self._socket.send(text)
        except websockets.ConnectionClosed as error:
            raise WeftError("closed", f"connection closed: {error}") from error

    async def close(self):
        """Ends the connection; open requests fail with code `closed`, iterations end."""
        self._closing = True
        if self._returning is not None:
            self._returning.cancel()
            await asyncio.wait([self._returning])
            self._news.set()
        if self._socket is not None:
            with contextlib.suppress(websockets.ConnectionClosed):  # the server has gone already
                await self._socket.close()
        if self._reader is not None:
            await self._reader

    async def __aenter__(self):
        return self

    async def __aexit__(self, *exception):
        await self.close()

    async def send(self, op: str, **members) -> dict:
        """Sends a request and returns its `ok` or `pong`; raises the server's `error` as WeftError."""
        ident = self._next_id
        self._next_id = ident + 1 if ident < 2147483647 else 1
        text = message_text(op, members, ident)
        future = self._requests[ident] = asyncio.get_running_loop().create_future()
        try:
            await self._write(text)
            answer = await asyncio.wait_for(future, self._timeout)
        except asyncio.TimeoutError:
            raise WeftError("timeout", f"no answer to {op} within {self._timeout} s") from None
        finally:
            del self._requests[ident]
            if op == "grab.release":
                self._held.discard(members["grab"])
        if op == "camera":
            self._camera = members
        if op == "scene.join":
            self._url = urllib.parse.urljoin(self._url, urllib.parse.quote(members["scene"], safe=""))
            self._held.clear()
        if "grab" in answer:
            self._held.add(answer["grab"])
        return answer

    async def post(self, op: str, **members) -> None:
        """Sends a message that only an error would answer (to `on_message`)."""
        await self._write(message_text(op, members))

    async def surface(self, obstacle: int) -> dict:
        """What a mesh of the scene looks like, by its place in `scene`: `vertices`, x, y, z of each in the mesh's own axes (m), and
        `triangles`, three vertices each, counterclockwise as seen from outside."""
        place = f"{urllib.parse.quote(self.scene['name'], safe='')}/meshes/{obstacle}"
        url = urllib.parse.urljoin("http" + self._url[len("ws"):], place)
        request = urllib.request.Request(url, headers=self._headers)
        try:
            with await asyncio.to_thread(urllib.request.urlopen, request, timeout=self._timeout, context=self._tls) as answer:
                return json.loads(answer.read())
        except urllib.error.HTTPError as error:
            raise WeftError("not_found", f"{url}: {error}") from error
        except OSError as error:
            raise WeftError("connect", f"{url}: {error}") from error

    # operations: generated by protocol/spec/generate.py from operations.json
    async def list_scenes(self) -> typing.List[dict]:
        """Asks which scenes there are."""
        ok = await self.send("scene.list")
        return ok["scenes"]

    async def join_scene(self, scene: str) -> dict:
        """Leaves the scene and joins another. `ok`, then `scene`, then its frames. Capabilities stay.

        scene: its name
        """
        return await self.send("scene.join", scene=scene)

    async def resume_seat(self, seat: str) -> dict:
        """Takes over what this client held before its connection broke. `seat` is that of the `scene` message before.
        Whoever left without closing the WebSocket is waited for 5 s, as well when the server itself was restarted (with
        `--data`); until then its hands hold on. `ok` has the ids of `grabs` that are this viewer's now.

        seat: from `scene`
        """
        return await self.send("seat.resume", seat=seat)

    async def camera(self, *, distance: typing.Optional[float] = None, eye: typing.Optional[Vector] = None,
                     target: typing.Optional[Vector] = None, half_angle: typing.Optional[float] = None) -> dict:
        """Tells where this viewer's camera is. Decides the level of each cloth (Eq. 7) for this viewer and, with
        `target` and `half_angle`, what it has in sight: all within that angle of the line from the eye to the target.
        Without them it sees in every direction.

        distance: from the cloths, 0..1e6 m
        eye: where the camera is, m
        target: what it looks at, another point than the eye, m
        half_angle: how far from the line to the target it sees, 0.001..3.14 rad
        """
        return await self.send("camera", distance=distance, eye=eye, target=target, half_angle=half_angle)

    async def add_ball(self, position: Vector, radius: float, *, velocity: typing.Optional[Vector] = None,
                       motion: typing.Optional[str] = None, mass: typing.Optional[float] = None,
                       friction: typing.Optional[float] = None) -> int:
        """A ball comes in. Returns its id.

        position: m
        radius: at most the diagonal of the scene's largest cloth, 0.01..10 m
        velocity: m/s
        motion: it stands or is moved, or it flies
        mass: of a dynamic ball, 0.001..10000 kg
        friction: Coulomb's coefficient, 0..10
        """
        ok = await self.send("ball.add", position=position, radius=radius, velocity=velocity, motion=motion, mass=mass,
                             friction=friction)
        return ok["ball"]

    async def move_ball(self, ball: int, position: Vector) -> dict:
        """The ball becomes kinematic and goes there within one step.

        ball: a ball's id, as `ball.add` gave it
        position: m
        """
        return await self.send("ball.move", ball=ball, position=position)

    async def throw_ball(self, ball: int, velocity: Vector) -> dict:
        """The ball becomes dynamic and flies off.

        ball: a ball's id, as `ball.add` gave it
        velocity: m/s
        """
        return await self.send("ball.throw", ball=ball, velocity=velocity)

    async def remove_ball(self, ball: int) -> dict:
        """The ball is gone.

        ball: a ball's id, as `ball.add` gave it
        """
        return await self.send("ball.remove", ball=ball)

    async def move_obstacle(self, obstacle: int, position: Vector, *, quaternion: typing.Optional[Turn] = None) -> dict:
        """The obstacle leaves its path, goes there within one step and stays.

        obstacle: its place in `scene`'s `obstacles`, from 0
        position: m
        quaternion: w, x, y, z: its own axes to the world's, any but zero, normalised; without one it keeps its turn;
            planes keep their normal
        """
        return await self.send("obstacle.move", obstacle=obstacle, position=position, quaternion=quaternion)

    async def throw_obstacle(self, obstacle: int, velocity: Vector, *, spin: typing.Optional[Vector] = None) -> dict:
        """An obstacle that has a `mass` becomes dynamic, leaves its path and flies off.

        obstacle: its place in `scene`'s `obstacles`, from 0
        velocity: m/s
        spin: about the world's axes, rad/s
        """
        return await self.send("obstacle.throw", obstacle=obstacle, velocity=velocity, spin=spin)

    async def grab(self, cloth: int, u: float, v: float, *, position: typing.Optional[Vector] = None,
                   max_force: typing.Optional[float] = None) -> int:
        """A hand takes hold of a cloth. The cloth is pulled towards the hand by at most `max_force`. Only the viewer
        that took hold can move the hand; it lets go when that viewer leaves, and at a reset. Returns its id.

        cloth: the cloth's number in `scene`
        u: across the cloth, from its left edge, 0..1
        v: down the cloth, from its top edge, 0..1
        position: the hand's; without one where the cloth is, m
        max_force: 0.001..10000 N
        """
        ok = await self.send("cloth.grab", cloth=cloth, u=u, v=v, position=position, max_force=max_force)
        return ok["grab"]

    async def grab_obstacle(self, obstacle: int, *, point: typing.Optional[Vector] = None,
                            position: typing.Optional[Vector] = None, max_force: typing.Optional[float] = None) -> int:
        """A hand takes hold of an obstacle that has a `mass`. It leaves its path and falls but for the hand: the point
        is pulled towards the hand by at most `max_force`, and turning is damped. Who may move the hand is as with
        `cloth.grab`. After an `obstacle.move` nothing is pulled until an `obstacle.throw`. Returns its id.

        obstacle: its place in `scene`'s `obstacles`, from 0
        point: what is held, from the obstacle's place along its own axes, m
        position: the hand's; without one where the point is, m
        max_force: 0.001..10000 N
        """
        ok = await self.send("obstacle.grab", obstacle=obstacle, point=point, position=position, max_force=max_force)
        return ok["grab"]

    async def move_grab(self, grab: int, position: Vector) -> dict:
        """The hand goes there; what it holds follows.

        grab: an id that `cloth.grab` or `obstacle.grab` gave
        position: m
        """
        return await self.send("grab.move", grab=grab, position=position)

    async def release(self, grab: int) -> dict:
        """The hand lets go.

        grab: an id that `cloth.grab` or `obstacle.grab` gave
        """
        return await self.send("grab.release", grab=grab)

    async def pin(self, cloth: int, u: float, v: float) -> dict:
        """The node nearest to (u, v) is held where it is, until it is unpinned or the scene is reset.

        cloth: the cloth's number in `scene`
        u: across the cloth, from its left edge, 0..1
        v: down the cloth, from its top edge, 0..1
        """
        return await self.send("cloth.pin", cloth=cloth, u=u, v=v)

    async def unpin(self, cloth: int, u: float, v: float) -> dict:
        """The pin that holds (u, v), or the nearest one, is removed.

        cloth: the cloth's number in `scene`
        u: across the cloth, from its left edge, 0..1
        v: down the cloth, from its top edge, 0..1
        """
        return await self.send("cloth.unpin", cloth=cloth, u=u, v=v)

    async def tune_cloth(self, cloth: int, **parameters) -> dict:
        """Changes numbers of a cloth's material from the next step on. The others stay. `rigidity` may be one number
        for all three. A value that it has already changes nothing and is not told.

        cloth: the cloth's number in `scene`
        parameters: each within the range that `scene`'s `material_tunable` has for it
        """
        return await self.send("cloth.tune", cloth=cloth, parameters=parameters)

    async def set_friction(self, friction: float, *, ball: typing.Optional[int] = None,
                           obstacle: typing.Optional[int] = None) -> dict:
        """Sets Coulomb's coefficient of what cloth slides on: of that ball or obstacle, or with neither of all. Between
        two bodies the geometric mean of theirs counts.

        friction: Coulomb's coefficient, 0..10
        ball: a ball's id, as `ball.add` gave it
        obstacle: its place in `scene`'s `obstacles`, from 0
        """
        return await self.send("friction.set", friction=friction, ball=ball, obstacle=obstacle)

    async def set_effect(self, effect: str, on: bool) -> dict:
        """Switches an effect of the scene off or on. Off, the scene is stepped as if it did not list it. A reset
        switches all on.

        effect: one of `scene`'s `effects`
        """
        return await self.send("effect.set", effect=effect, on=on)

    async def tune_effect(self, effect: str, **parameters) -> dict:
        """Changes parameters of an effect from the next step on, also while it is off. The others stay. A `lift` that
        the scene does not give follows `drag`. `strength` may be one number for both directions.

        effect: one of `scene`'s `effects`
        parameters: each within the range that `scene`'s `tunable` has for it
        """
        return await self.send("effect.tune", effect=effect, parameters=parameters)

    async def set_wind(self, direction: Vector, speed: float, *, gusts: typing.Optional[float] = None,
                       turbulence: typing.Optional[float] = None, time_scale: typing.Optional[float] = None,
                       length_scale: typing.Optional[float] = None) -> dict:
        """Sets the wind; what is left out stays as it is.

        direction: any length but zero; normalised
        speed: mean, 0..100 m/s
        gusts: how strong gusts are: root mean square of the change over the speed, 0..1
        turbulence: how strong eddies are: the same of each component, 0..1
        time_scale: how long gusts last, 0.05..1000 s
        length_scale: how large eddies are, 0.01..1000 m
        """
        return await self.send("wind.set", direction=direction, speed=speed, gusts=gusts, turbulence=turbulence,
                               time_scale=time_scale, length_scale=length_scale)

    async def set_wind_zone(self, zone: int, velocity: Vector) -> dict:
        """Sets how the air moves in one of the wind's zones.

        zone: its place in the wind's `zones`, from 0
        velocity: m/s
        """
        return await self.send("wind.zone.set", zone=zone, velocity=velocity)

    async def set_quality(self, *, max_error: typing.Optional[float] = None,
                          max_ms: typing.Optional[float] = None) -> dict:
        """Holds the scene to an error or to a time, for all viewers; with neither it is stepped in its own way. It is
        stepped in the cheapest way expected to stay within that error, or in the most accurate way within that wall
        time a step. `ok` carries `quality`, as in `stats`.

        max_error: share of the cloth's size, 1e-6..1
        max_ms: wall time of a step, 0.01..1000 ms
        """
        return await self.send("quality", max_error=max_error, max_ms=max_ms)

    async def ask_cost(self) -> dict:
        """Asks what accuracy costs: `curve` follows, as soon as it is measured."""
        return await self.send("cost")

    async def pause(self) -> dict:
        """Stops the scene's clock, for all viewers."""
        return await self.send("pause")

    async def resume(self) -> dict:
        """Lets the scene's clock go on, for all viewers."""
        return await self.send("resume")

    async def reset(self) -> dict:
        """Puts the scene back to its start, for all viewers. `ok` carries `epoch`, the new one."""
        return await self.send("reset")

    async def step(self, count: int = 1) -> dict:
        """Steps a paused scene. `ok.f` is the step at which the scene stands still again. The steps are made as fast as
        they go, not in real time; of their frames at most 60 a second are sent, and the last.

        count: 1..600
        """
        return await self.send("step", count=count)

    # operations: end

    async def ping(self) -> float:
        """Round-trip time, s. The answer comes after the replies to all commands sent before, so that it is a barrier. Each
        ping that is quicker than those before tells better how the server's clock goes (`age`)."""
        clock = asyncio.get_running_loop().time
        start = clock()
        pong = await self.send("ping", t=start)
        end = clock()
        if end - start < self._quickest_ping and "server_ms" in pong:
            self._quickest_ping = end - start
            self._clock_offset_ms = pong["server_ms"] - 500 * (start + end)
        return end - start

    def age(self, frame: Frame) -> float:
        """How long ago, ms, the server sent the frame off, to about half of the quickest ping's round trip. NaN before the
        first ping."""
        now = 1000 * asyncio.get_running_loop().time() + self._clock_offset_ms
        return math.remainder(now - frame.stamp.server_ms, 2.0 ** 32)  # the clock wraps round

    def __aiter__(self):
        return self

    async def __anext__(self) -> Frame:
        """The newest frame not seen yet, acknowledged as it is taken. Frames nobody takes are not acknowledged, and the server
        then stops sending. Ends when either side closes in order; raises WeftError when the connection is lost and not made
        again."""
        while self._newest is None:
            if self._lost and (self._closing or self._returning is None or self._returning.done()):
                if self._closing or self._socket.close_code in (1000, 1001):
                    raise StopAsyncIteration
                raise self._lost
            self._news.clear()
            await self._news.wait()
        message, self._newest = self._newest, None
        frame = decode_frame(message)
        if self._acks and not self._lost:
            try:
                await self.post("ack", f=frame.stamp.f)
            except WeftError:
                pass  # closed meanwhile: the next frame asked for tells
        return frame

    async def next_frame(self, accept: typing.Callable[[Frame], bool] = lambda frame: True,
                         timeout: typing.Optional[float] = None) -> Frame:
        """The next frame for which `accept` is true, within `timeout` s (default: that of the connection)."""
        async def search():
            async for frame in self:
                if accept(frame):
                    return frame
            raise WeftError("closed", "closed before such a frame")
        seconds = self._timeout if timeout is None else timeout
        try:
            return await asyncio.wait_for(search(), seconds)
        except asyncio.TimeoutError:
            raise WeftError("timeout", f"no such frame within {seconds} s") from None
