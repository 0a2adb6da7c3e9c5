"""What goes wrong between a client and its server."""
from __future__ import annotations


class WeftError(Exception):
    """A request refused by the server, a malformed frame, or a connection that failed.

    `code` is one of PROTOCOL.md's, or `bad_frame`, `closed`, `timeout`, `connect`; `path` a JSON pointer into the request.
    """

    def __init__(self, code: str, message: str, path: str = "") -> None:
        super().__init__(message)
        self.code, self.message, self.path = code, message, path


def malformed(reason: str) -> WeftError:
    return WeftError("bad_frame", reason)
