"""Frames on their way to who takes them: the newest wins."""
from __future__ import annotations

import asyncio
import contextlib
import typing

from .clock import Arrivals, now
from .errors import WeftError
from .frames import decode_frame
from .types import Frame

_NEWER_S = 0.2  # that a newer frame is waited for: a round trip and a step


class Delivery:
    def __init__(self, check: typing.Callable[[], None], acknowledge: typing.Callable[[Frame], typing.Awaitable[None]]) -> None:
        """`check` raises what ends the frames, if there will be no more; `acknowledge` tells the server of one that is taken."""
        self._check, self._acknowledge = check, acknowledge
        self._news = asyncio.Event()
        self.clear()

    def clear(self) -> None:
        """Forgets the connection before."""
        self._newest: bytes | None = None
        self._told: bytes | None = None    # acknowledged
        self._until: float | None = None   # a newer one is waited for in place of one that is late
        self._arrivals = Arrivals()

    def put(self, message: bytes) -> None:
        """Takes a binary message, in place of one that has not been taken yet."""
        self._newest = message
        self._news.set()

    def wake(self) -> None:
        """Whether there will be more is to be checked again."""
        self._news.set()

    async def take(self) -> Frame:
        """The newest frame. One that is late has waited until this program read again and is old: a newer one is waited for,
        for `_NEWER_S` at most, as nothing may move. Cancelled, it leaves the frame to whoever asks next."""
        while True:
            while self._newest is None:
                self._check()
                self._news.clear()
                await self._news.wait()
            message = self._newest
            try:
                frame = decode_frame(message)
            except WeftError:
                self._newest = None
                raise
            if self._told is not message:
                self._told = message
                await self._acknowledge(frame)
            if not self._arrivals.late(frame.stamp.server_ms):
                return self._given(message, frame)
            self._until = self._until or now() + _NEWER_S
            if now() >= self._until:
                return self._given(message, frame)
            if self._newest is message:
                self._news.clear()
                with contextlib.suppress(asyncio.TimeoutError):
                    await asyncio.wait_for(self._news.wait(), self._until - now())

    def _given(self, message: bytes, frame: Frame) -> Frame:
        if self._newest is message:
            self._newest = None
        self._told = self._until = None
        self._arrivals.taken(frame.stamp.server_ms)
        return frame
