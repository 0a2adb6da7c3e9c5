"""The Python client's methods: for asyncio (clients/python/weft/commands.py) and without (sync_commands.py)."""
import json
import textwrap

from .table import BY, described, is_required, members_of, methods, told

HEADS = {
    "async ": f'''"""A method for each operation of PROTOCOL.md section 2, for asyncio. {BY}."""
from __future__ import annotations

import abc
import typing

from .types import Message, Motion, Parameter, Turn, Vector


class Commands(abc.ABC):
    """The methods, whatever carries them: who extends it sends."""

    @abc.abstractmethod
    async def send(self, op: str, **members: typing.Any) -> Message:
        """Sends a request and returns its `ok` or `pong`; raises the server's `error` as WeftError."""

''',
    "": f'''"""A method for each operation of PROTOCOL.md section 2; each waits for its answer. {BY}."""
from __future__ import annotations

import abc
import typing

from .types import Message, Motion, Parameter, Turn, Vector


class SyncCommands(abc.ABC):
    """The methods, whatever carries them: who extends it sends."""

    @abc.abstractmethod
    def send(self, op: str, **members: typing.Any) -> Message:
        """Sends a request and returns its `ok` or `pong`; raises the server's `error` as WeftError."""

'''}


def python_commands(kind):
    """The module with all methods; `kind` stands before each `def`: "async ", or nothing for those that wait."""
    return HEADS[kind] + "\n\n".join(python_method(operation, kind) for operation in methods("python")) + "\n"


def filled(head, items, tail, width=120):
    """head + items separated by commas + tail, in lines that begin below the first item."""
    lines, line = [], head
    for index, item in enumerate(items):
        piece = item + (tail if index == len(items) - 1 else ",")
        if len(line) + 1 + len(piece) > width and line != head:
            lines.append(line)
            line = " " * len(head) + piece
        else:
            line += piece if line.endswith("(") else " " + piece
    return "\n".join(lines + [line if items else head + tail])


def python_method(operation, kind):
    members, client = members_of(operation), operation["client"]
    arguments, keywords, sent = ["self"], [], []
    for member in members:
        if member["type"] == "parameters":
            keywords.append(f"**{member['name']}: Parameter")
        elif is_required(member):
            arguments.append(f"{member['name']}: {member['python']}")
        elif member.get("positional"):
            arguments.append(f"{member['name']}: {member['python']} = {json.dumps(member['default'])}")
        else:
            keywords.append(f"{member['name']}: {member['python']} | None = None")
        sent.append(f"{member['name']}={member['name']}")
    if keywords and not keywords[0].startswith("**"):
        arguments.append("*")
    returned = f"        {client['returns']}: {client['python']} =" if "returns" in client else "        return"
    tail = f')["{client["returns"]}"]' if "returns" in client else ")"
    waiting = "await " if kind else ""
    if "returns" in client and kind:
        waiting, tail = "(await ", f'){tail}'
    call = filled(f"{returned} {waiting}self.send(", [f'"{operation["op"]}"'] + sent, tail)
    lines = [filled(f"    {kind}def {client['name']}(", arguments + keywords, f") -> {client.get('python', 'Message')}:")]
    lines += [("        " + line).rstrip() for line in docstring(operation, members)] + [call]
    if "returns" in client:
        lines.append(f"        return {client['returns']}")
    return "\n".join(lines)


def docstring(operation, members):
    client = operation["client"]
    doc = described(operation, client.get("returns"))
    if "returns" in client and len(operation["ok"][client["returns"]]) < 30:
        doc += f" Returns {operation['ok'][client['returns']]}."
    lines = textwrap.wrap(f'"""{doc}', 112, break_long_words=False, break_on_hyphens=False)
    notes = [f"{member['name']}: {told(member)}" for member in members if told(member)]
    if not notes:
        lines[-1] += '"""'
        return lines
    lines += [""]
    for note in notes:
        lines += textwrap.wrap(note, 112, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
    return lines + ['"""']
