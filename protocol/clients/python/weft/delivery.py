"""Frames on their way to who takes them: the newest wins."""
from __future__ import annotations

import asyncio
import typing

from .clock import Arrivals, now
from .frames import decode_frame
from .types import Frame

_NEWER_S = 0.2  # that a newer frame is waited for: a round trip and a step


class Delivery:
    def __init__(self, check: typing.Callable[[], None], acknowledge: typing.Callable[[Frame], typing.Awaitable[None]]) -> None:
        """`check` raises what ends the frames, if there will be no more; `acknowledge` tells the server of one that is taken."""
        self._check, self._acknowledge = check, acknowledge
        self._newest: bytes | None = None
        self._news = asyncio.Event()
        self._arrivals = Arrivals()

    def put(self, message: bytes) -> None:
        """Takes a binary message, in place of one that has not been taken yet."""
        self._newest = message
        self._news.set()

    def clear(self) -> None:
        """Forgets the connection before."""
        self._newest, self._arrivals = None, Arrivals()

    def wake(self) -> None:
        """Whether there will be more is to be checked again."""
        self._news.set()

    async def take(self) -> Frame:
        """The newest frame. One that is late has waited until this program read again and is old: a newer one is waited for,
        for `_NEWER_S` at most, as nothing may move."""
        while self._newest is None:
            self._check()
            await self._news_come()
        message, end = self._newest, now() + _NEWER_S
        frame = await self._taken(message)
        try:
            while self._arrivals.late(frame.stamp.server_ms) and now() < end:
                if self._newest is None:
                    await asyncio.wait_for(self._news_come(), end - now())
                if self._newest is None:  # the connection has ended
                    break
                message = self._newest
                frame = await self._taken(message)
        except asyncio.TimeoutError:
            pass
        except asyncio.CancelledError:
            self._newest = self._newest or message  # whoever asks next has it
            raise
        self._arrivals.taken(frame.stamp.server_ms)
        return frame

    async def _news_come(self) -> None:
        self._news.clear()
        await self._news.wait()

    async def _taken(self, message: bytes) -> Frame:
        self._newest = None
        frame = decode_frame(message)
        await self._acknowledge(frame)
        return frame
