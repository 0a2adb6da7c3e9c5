"""The server's clock, as far as pings tell (PROTOCOL.md: `pong.server_ms`)."""
from __future__ import annotations

import math
import time
import typing

WRAP_MS = 2.0 ** 32
#: A frame that is by so much later than the one before has waited until this side read again. Of one that takes them seldom: by
#: twice its pace.
LATE_MS = 100.0

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
    """Tells frames that have waited because this side stood still from those whose way is long, or which it takes seldom."""

    def __init__(self) -> None:
        self._usual_ms = math.nan  # from its sending to its being taken, the last one's, both clocks' difference included
        self._last_ms = math.nan   # when it was taken
        self._pace_ms = 0.0        # from the one before to it

    def late(self, server_ms: float) -> bool:
        """Whether a frame sent at `server_ms` is taken later than the one before it was, by more than `LATE_MS`."""
        late = math.remainder(1000 * now() - server_ms - self._usual_ms, WRAP_MS)
        return late > max(LATE_MS, 2 * self._pace_ms)

    def taken(self, server_ms: float) -> None:
        ms = 1000 * now()
        if self._last_ms <= ms:
            self._pace_ms = ms - self._last_ms
        self._last_ms, self._usual_ms = ms, ms - server_ms
