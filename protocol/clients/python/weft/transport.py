"""How a server is reached: the WebSocket, plain requests beside it, and when to try again (PROTOCOL.md section 1)."""
from __future__ import annotations

import asyncio
import json
import random
import ssl
import typing
import urllib.error
import urllib.parse
import urllib.request

from websockets.legacy.client import WebSocketClientProtocol, connect
from websockets.typing import Subprotocol

from .errors import WeftError

SUBPROTOCOL = Subprotocol("weft.v1")
MAX_MESSAGE_BYTES = 64 * 1024 * 1024  # of the server's messages: far beyond any scene


def backoff(attempt: int, random: typing.Callable[[], float] = random.random) -> float:
    """s to wait before the attempt, counted from 0: doubled from 0.25 to 10, less up to half of it by chance."""
    return min(10.0, 0.25 * 2.0 ** min(attempt, 10)) * (0.5 + 0.5 * random())


class Transport:
    """The way to a server: whom it trusts, and by which token it is let in."""

    def __init__(self, token: typing.Optional[str], tls: typing.Optional[ssl.SSLContext]) -> None:
        self._headers = {"Authorization": f"Bearer {token}"} if token else {}
        self._tls = tls

    async def open(self, url: str) -> WebSocketClientProtocol:
        """Opens a WebSocket; the server negotiates no compression, and saying so spares the offer."""
        secure: typing.Dict[str, typing.Any] = {"ssl": self._tls} if self._tls and url.startswith("wss:") else {}
        return await connect(url, subprotocols=[SUBPROTOCOL], compression=None, max_size=MAX_MESSAGE_BYTES, open_timeout=None,
                             extra_headers=self._headers, **secure)

    async def fetch(self, url: str, timeout: float) -> typing.Any:
        """The JSON at an address of the server."""
        request = urllib.request.Request(url, headers=self._headers)

        def read() -> typing.Any:
            with urllib.request.urlopen(request, timeout=timeout, context=self._tls) as answer:
                return json.loads(answer.read())

        try:
            return await asyncio.get_running_loop().run_in_executor(None, read)
        except urllib.error.HTTPError as error:
            raise WeftError("not_found", f"{url}: {error}") from error
        except OSError as error:
            raise WeftError("connect", f"{url}: {error}") from error
