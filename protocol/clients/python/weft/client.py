"""A connection to one scene, for asyncio: greeted, followed, and made again where it breaks."""
from __future__ import annotations

import asyncio
import contextlib
import json
import ssl
import typing
import urllib.parse

from websockets.exceptions import ConnectionClosed, WebSocketException
from websockets.legacy.client import WebSocketClientProtocol

from .clock import ServerClock, now
from .commands import Commands
from .delivery import Delivery
from .errors import WeftError
from .messages import message_text
from .requests import Requests
from .transport import Transport, backoff
from .types import Frame, Message

_MOST_SEATS = 8  # what is held waits 5 s; in these there are fewer attempts
OnMessage = typing.Callable[[Message], None]


async def connect(url: str, *, client: str | None = None, window: int = 2, coarser: bool = False, compact: bool = False,
                  timeout: float = 5.0, on_message: OnMessage | None = None, token: str | None = None, tls: ssl.SSLContext | None = None,
                  reconnect: bool = False) -> Client:
    """Connects to a scene, ws://HOST:PORT/v1/scenes/NAME or wss://: done when the server has greeted, described the scene,
    and agreed on the flow of frames.

    client      name told to the server
    window      unacknowledged frames, 1..8, beside those that the way has room for; 0: no flow control, the server sends as
                fast as it can
    coarser     cloths may be sent at coarser levels than the camera asks for, where the link carries too few frames
    compact     frames a fifth smaller and more, which take much longer to decode: 65 x 65 nodes 12 ms and not 0.5
    timeout     s to wait for the connection, and for each reply
    on_message  called with each message that answers no request: `welcome`, `scene`, `event`, `stats`, `curve`,
                `notice`, `error`
    token       the server's, where it asks for one
    tls         whom to trust with wss://, as ssl.create_default_context(cafile=...); without one whom this machine trusts
    reconnect   when the connection breaks it is made again, tried after 0.25, 0.5, 1 s and so on to 10 s, until `close`: at
                the same camera, with what this client held if that is within 5 s. Frames go on; what is sent meanwhile fails
                with code `closed`
    """
    caps = (["flow.ack"] if window else []) + (["flow.level"] if coarser else []) + (["grid.rice"] if compact else [])
    hello = {"client": client, "caps": caps, "window": window or None} if caps or client else None
    connection = Client(url, timeout, on_message, Transport(token, tls), hello, reconnect)
    try:
        await connection._open()
    except WeftError:
        await connection.close()
        raise
    return connection


class Client(Commands):
    """A connection to one scene. Made by `connect`; iterate over it for frames."""

    def __init__(self, url: str, timeout: float, on_message: OnMessage | None, transport: Transport, hello: Message | None,
                 reconnect: bool) -> None:
        self.welcome: Message = {}  #: the server's `welcome`; empty until the connection is made
        self.scene: Message = {}    #: the newest `scene` message; likewise
        self.stats: Message = {}    #: the newest `stats` message; empty until there is one
        self._url, self._hello, self._reconnect, self._transport = url, hello, reconnect, transport
        self._timeout, self._on_message = timeout, on_message
        self._socket: WebSocketClientProtocol | None = None
        self._reader: asyncio.Task[None] | None = None
        self._acks = False
        self._closing = False
        self._lost: WeftError | None = None
        self._requests, self._clock = Requests(timeout), ServerClock()
        self._frames = Delivery(self._check, self._acknowledge)
        self._greeted = asyncio.Event()
        self._greeted_once = False
        self._returning: asyncio.Task[None] | None = None  # while the connection is made again
        self._camera: Message = {}        # as it was told last
        self._before: typing.List[Message] = []  # `scene` of connections that broke, by whose seats what it holds may be had
        self._held: typing.Set[int] = set()  # ids of grabs that this client has not let go of

    async def __aenter__(self) -> Client:
        return self

    async def __aexit__(self, *exception: object) -> None:
        await self.close()

    async def close(self) -> None:
        """Ends the connection; open requests fail with code `closed`, iterations end."""
        self._closing = True
        if self._returning is not None:
            self._returning.cancel()
            await asyncio.wait([self._returning])
            self._frames.wake()
        if self._socket is not None:
            with contextlib.suppress(ConnectionClosed):  # the server has gone already
                await self._socket.close()
        if self._reader is not None:
            await self._reader

    async def send(self, op: str, **members: typing.Any) -> Message:
        """Sends a request and returns its `ok` or `pong`; raises the server's `error` as WeftError."""
        try:
            answer = await self._requests.make(op, members, self._write)
        finally:
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

    async def post(self, op: str, **members: typing.Any) -> None:
        """Sends a message that only an error would answer (to `on_message`)."""
        await self._write(message_text(op, members))

    async def surface(self, obstacle: int) -> Message:
        """What a mesh of the scene looks like, by its place in `scene`: `vertices`, x, y, z of each in the mesh's own axes (m),
        and `triangles`, three vertices each, counterclockwise as seen from outside."""
        place = f"{urllib.parse.quote(self.scene['name'], safe='')}/meshes/{obstacle}"
        surface: Message = await self._transport.fetch(urllib.parse.urljoin("http" + self._url[len("ws"):], place), self._timeout)
        return surface

    async def ping(self) -> float:
        """Round-trip time, s. The answer comes after the replies to all commands sent before, so that it is a barrier. Each
        ping that is quicker than those before tells better how the server's clock goes (`age`)."""
        start = now()
        pong = await self.send("ping", t=start)
        end = now()
        self._clock.note(start, end, pong.get("server_ms"))
        return end - start

    def age(self, frame: Frame) -> float:
        """How long ago, ms, the server sent the frame off, to about half of the quickest ping's round trip. NaN before the
        first ping."""
        return self._clock.age(frame.stamp.server_ms)

    def __aiter__(self) -> Client:
        return self

    async def __anext__(self) -> Frame:
        """The newest frame not seen yet, acknowledged as it is taken. Frames nobody takes are not acknowledged, and the server
        then stops sending: what has waited so until this program read again is passed over for a newer one, if there is one
        within 0.2 s. Ends when either side closes in order; raises WeftError when the connection is lost and not made again."""
        return await self._frames.take()

    def _check(self) -> None:
        """Raises what ends the frames, if the connection is lost and will not be made again."""
        if self._lost and (self._closing or self._returning is None or self._returning.done()):
            if self._closing or self._socket is None or self._socket.close_code in (1000, 1001):
                raise StopAsyncIteration
            raise self._lost

    async def _acknowledge(self, frame: Frame) -> None:
        if self._acks and not self._lost:
            with contextlib.suppress(WeftError):  # closed meanwhile: the next frame asked for tells
                await self.post("ack", f=frame.stamp.f)

    async def next_frame(self, accept: typing.Callable[[Frame], object] = lambda frame: True,
                         timeout: float | None = None) -> Frame:
        """The next frame for which `accept` is true, within `timeout` s (default: that of the connection)."""
        async def search() -> Frame:
            async for frame in self:
                if accept(frame):
                    return frame
            raise WeftError("closed", "closed before such a frame")
        seconds = self._timeout if timeout is None else timeout
        try:
            return await asyncio.wait_for(search(), seconds)
        except asyncio.TimeoutError:
            raise WeftError("timeout", f"no such frame within {seconds} s") from None

    async def _open(self) -> None:
        """Connects: greeted, the scene described, `hello` answered, and where it was before as far as that can be."""
        # One that breaks before it has taken over what an older one held is only the next to be asked for.
        self._before = [*self._before, *([self.scene] if self.scene.get("seat") else [])][-_MOST_SEATS:] if self._held else []
        self.welcome, self.scene, self._lost, self._acks = {}, {}, None, False
        self._clock = ServerClock()
        self._frames.clear()
        self._greeted.clear()
        try:
            await asyncio.wait_for(self._greet(), self._timeout)
        except asyncio.TimeoutError:
            raise WeftError("timeout", f"no connection to {self._url} within {self._timeout} s") from None
        except (OSError, WebSocketException) as error:
            raise WeftError("connect", f"no connection to {self._url}: {error}") from error
        if self._hello:
            await self.send("hello", **self._hello)
        if self._camera:
            with contextlib.suppress(WeftError):  # refused then, it is refused now
                await self.send("camera", **self._camera)
        await self._resume()
        if self._lost:  # broken again meanwhile
            raise self._lost

    async def _greet(self) -> None:
        self._socket = await self._transport.open(self._url)
        self._reader = asyncio.create_task(self._read(self._socket))
        await self._greeted.wait()
        if self._lost:
            raise self._lost

    async def _resume(self) -> None:
        """Takes over what this client held before its connection broke, and lets go of what it let go of meanwhile."""
        grabs: typing.Set[int] = set()
        for before in self._before:
            if before["name"] != self.scene["name"]:
                continue
            try:
                grabs = set((await self.resume_seat(before["seat"]))["grabs"])
            except WeftError as error:
                if error.code in ("closed", "timeout"):  # broken again: it is asked for once more
                    raise
                # Else it is too late, and all is released.
        self._before = []
        for grab in grabs - self._held:
            await self.post("grab.release", grab=grab)
        self._held &= grabs

    async def _return(self) -> None:
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

    async def _read(self, socket: WebSocketClientProtocol) -> None:
        """Takes everything in as it comes, so that nothing queues: replies to their requests, frames to the newest."""
        error = None
        try:
            async for message in socket:
                if isinstance(message, bytes):
                    self._frames.put(message)
                else:
                    self._receive(json.loads(message))
        except ConnectionClosed:
            pass
        except Exception as failure:  # of on_message, or a server that does not speak the protocol
            error = WeftError("closed", f"reading stopped: {failure!r}")
            await socket.close(1002 if isinstance(failure, ValueError) else 1000)
        code, reason = socket.close_code, socket.close_reason
        self._lost = error or WeftError("closed", f"connection closed with {code}{f': {reason}' if reason else ''}")
        self._requests.fail(self._lost)
        self._frames.wake()
        self._greeted.set()
        returning = self._returning is not None and not self._returning.done()
        if self._reconnect and not self._closing and error is None and not returning and self._greeted_once:
            self._returning = asyncio.create_task(self._return())

    def _receive(self, message: Message) -> None:
        op = message.get("op")
        # Noted here and not where `hello` is awaited: a frame may be taken before that code runs.
        if op == "ok" and "caps" in message:
            self._acks = "flow.ack" in message["caps"]
        if self._requests.settle(message):
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

    async def _write(self, text: str) -> None:
        if self._lost:
            raise self._lost
        if self._socket is None:
            raise WeftError("closed", "not connected")
        try:
            await self._socket.send(text)
        except ConnectionClosed as error:
            raise WeftError("closed", f"connection closed: {error}") from error
