"""Requests that wait for their answers (PROTOCOL.md section 2)."""
from __future__ import annotations

import asyncio
import typing

from .errors import WeftError
from .messages import message_text
from .types import Message

LAST_ID = 2147483647


class Requests:
    def __init__(self, timeout: float) -> None:
        """timeout: s that an answer may take"""
        self._timeout = timeout
        self._next_id = 1
        self._waiting: typing.Dict[int, asyncio.Future[Message]] = {}

    async def make(self, op: str, members: Message, transmit: typing.Callable[[str], typing.Awaitable[None]]) -> Message:
        """Sends a request by `transmit` and returns its answer; raises the server's `error`."""
        ident = self._next_id
        self._next_id = ident + 1 if ident < LAST_ID else 1
        text = message_text(op, members, ident)
        future = self._waiting[ident] = asyncio.get_running_loop().create_future()
        try:
            await transmit(text)
            return await asyncio.wait_for(future, self._timeout)
        except asyncio.TimeoutError:
            raise WeftError("timeout", f"no answer to {op} within {self._timeout} s") from None
        finally:
            del self._waiting[ident]

    def settle(self, message: Message) -> bool:
        """Gives a message to the request that it answers; False if it answers none."""
        future = self._waiting.get(message.get("re", 0))
        if future is None:
            return False
        if not future.done():
            if message["op"] == "error":
                future.set_exception(WeftError(message["code"], message["message"], message.get("path", "")))
            else:
                future.set_result(message)
        return True

    def fail(self, error: WeftError) -> None:
        """None will be answered."""
        for future in self._waiting.values():
            if not future.done():
                future.set_exception(error)
