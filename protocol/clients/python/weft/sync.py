"""A connection to one scene without asyncio: each call waits for its answer, frames are iterated over."""
from __future__ import annotations

import asyncio
import concurrent.futures
import ssl
import threading
import typing

from .client import Client, OnMessage, connect
from .errors import WeftError
from .sync_commands import SyncCommands
from .types import Frame, Message

T = typing.TypeVar("T")


def open(url: str, *, client: str | None = None, window: int = 2, coarser: bool = False, compact: bool = False,
         timeout: float = 5.0, on_message: OnMessage | None = None, token: str | None = None, tls: ssl.SSLContext | None = None,
         reconnect: bool = False) -> Scene:
    """Connects to a scene: `connect` for programs and notebooks that do not use asyncio. What it may be told is the same;
    `on_message` is called by a thread of the connection's own, and must not call the scene."""
    return Scene(connect(url, client=client, window=window, coarser=coarser, compact=compact, timeout=timeout,
                         on_message=on_message, token=token, tls=tls, reconnect=reconnect))


class Scene(SyncCommands):
    """A connection to one scene. Made by `open`; iterate over it for frames; a context manager that closes it."""

    def __init__(self, connecting: typing.Coroutine[typing.Any, typing.Any, Client]) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="weft", daemon=True)
        self._thread.start()
        try:
            self._client = self._wait(connecting)
        except BaseException:
            self._stop()
            raise

    @property
    def welcome(self) -> Message:
        """The server's `welcome`."""
        return self._client.welcome

    @property
    def scene(self) -> Message:
        """The newest `scene` message."""
        return self._client.scene

    @property
    def stats(self) -> Message:
        """The newest `stats` message; empty until there is one."""
        return self._client.stats

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the connection and its thread."""
        if self._thread.is_alive():
            try:
                self._wait(self._client.close())
            finally:
                self._stop()

    def send(self, op: str, **members: typing.Any) -> Message:
        """Sends a request and returns its `ok` or `pong`; raises the server's `error` as WeftError."""
        return self._wait(self._client.send(op, **members))

    def post(self, op: str, **members: typing.Any) -> None:
        """Sends a message that only an error would answer (to `on_message`)."""
        self._wait(self._client.post(op, **members))

    def surface(self, obstacle: int) -> Message:
        """What a mesh of the scene looks like: as `Client.surface`."""
        return self._wait(self._client.surface(obstacle))

    def ping(self) -> float:
        """Round-trip time, s: as `Client.ping`."""
        return self._wait(self._client.ping())

    def age(self, frame: Frame) -> float:
        """How long ago, ms, the server sent the frame off: as `Client.age`."""
        return self._client.age(frame)

    def __iter__(self) -> Scene:
        return self

    def __next__(self) -> Frame:
        """The newest frame not seen yet; ends and raises as iterating over `Client` does."""
        try:
            return self._wait(self._client.__anext__())
        except StopAsyncIteration:
            raise StopIteration from None

    def next_frame(self, accept: typing.Callable[[Frame], object] = lambda frame: True, timeout: float | None = None) -> Frame:
        """The next frame for which `accept` is true, within `timeout` s (default: that of the connection)."""
        return self._wait(self._client.next_frame(accept, timeout))

    def _wait(self, coroutine: typing.Coroutine[typing.Any, typing.Any, T]) -> T:
        """Lets the connection's thread do it, and waits for it; an interrupt ends it there, too."""
        if not self._thread.is_alive():
            coroutine.close()
            raise WeftError("closed", "closed by this client")
        future: concurrent.futures.Future[T] = asyncio.run_coroutine_threadsafe(coroutine, self._loop)
        try:
            return future.result()
        except BaseException:
            future.cancel()
            raise

    def _stop(self) -> None:
        asyncio.run_coroutine_threadsafe(_cancel_others(), self._loop).result()
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()


async def _cancel_others() -> None:
    """Ends what an interrupted attempt to connect has left."""
    others = asyncio.all_tasks() - {asyncio.current_task()}
    for task in others:
        task.cancel()
    await asyncio.gather(*others, return_exceptions=True)
