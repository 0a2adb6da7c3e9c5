"""The server's clock, as far as pings tell (PROTOCOL.md: `pong.server_ms`)."""
from __future__ import annotations

import math
import time
import typing

WRAP_MS = 2.0 ** 32
LATE_MS = 100.0  #: a frame that is by so much later than the one before has waited until this side read again

now = time.monotonic  #: s, of this side


class ServerClock:
    def __init__(self) -> None:
        self._quickest, self._offset_ms = math.inf, math.nan

    def note(self, start: float, end: float, server_ms: typing.Optional[float]) -> None:
        """A ping began at `start`, s, its answer came at `end` and has `server_ms`."""
        if end - start < self._quickest and server_ms is not None:
            self._quickest = end - start
            self._offset_ms = server_ms - 500 * (start + end)

    def age(self, server_ms: float) -> float:
        """How long ago it was `server_ms`, ms; NaN before the first ping."""
        return math.remainder(1000 * now() + self._offset_ms - server_ms, WRAP_MS)


class Arrivals:
    """Tells frames that have waited for this side to read from those whose way is long."""

    def __init__(self) -> None:
        self._usual_ms = math.nan  # from its sending to its being taken, the last one's, both clocks' difference included

    def late(self, server_ms: float) -> bool:
        """Whether a frame sent at `server_ms` is taken later than the one before it was, by more than `LATE_MS`."""
        return math.remainder(1000 * now() - server_ms - self._usual_ms, WRAP_MS) > LATE_MS

    def taken(self, server_ms: float) -> None:
        self._usual_ms = 1000 * now() - server_ms
