"""Control messages (PROTOCOL.md sections 2 and 3)."""
from __future__ import annotations

import json
import typing

import numpy as np

from .errors import WeftError
from .types import Message


def message_text(op: str, members: typing.Optional[Message] = None, id: typing.Optional[int] = None) -> str:
    """A client message as JSON text: op, id, then the members that are not None. Arrays and numbers may be numpy's."""
    message = {"op": op, "id": id, **(members or {})}
    try:
        return json.dumps({name: value for name, value in message.items() if value is not None}, allow_nan=False, default=_plain)
    except ValueError as error:
        raise WeftError("range", f"{op} has a number that is not finite") from error


def _plain(value: object) -> object:
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"{value!r} cannot be sent: allowed are numbers, texts, lists, dictionaries and numpy's arrays")
