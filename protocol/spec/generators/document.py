"""PROTOCOL.md's section of each operation."""
import json
import re
import textwrap

from .table import SPEC, described, interval, is_required, meaning, members_of


def allowed(member):
    """What a value may be, as the table of an operation has it."""
    parts = [member["value"]]
    if "range" in member and member["cpp"] not in ("std::string", "std::vector<std::string>"):
        parts.append(("each " if "[" in member["value"] else "") + interval(member))
    return " ".join(parts) + (f" {member['unit']}" if "unit" in member else "")


def documented(operation):
    lines = [f"#### `{operation['op']}`", ""]
    prose = described(operation)
    if "errors" in operation:
        errors = [re.sub(r"^(\w+)", r"`\1`", error) for error in operation["errors"]]
        prose += (" Error: " if len(errors) == 1 else " Errors: ") + "; ".join(errors) + "."
    if operation["role"] != "view":
        prose += f" Role: `{operation['role']}`."
    lines += textwrap.wrap(prose, 120, break_long_words=False, break_on_hyphens=False) + [""]
    if operation.get("members"):
        lines += ["| member | value | default | meaning |", "|---|---|---|---|"]
        for member in members_of(operation):
            default = "required" if is_required(member) else f"`{json.dumps(member['default'])}`" if "default" in member else "-"
            lines.append(f"| `{member['name']}` | {allowed(member)} | {default} | {meaning(member)} |".replace("|  |", "| |"))
        lines.append("")
    if "rules" in operation:
        lines += textwrap.wrap(" ".join(map(rule_text, operation["rules"])), 120, break_on_hyphens=False) + [""]
    examples = [json.dumps(example, separators=(",", ":")) for example in operation["examples"]]
    return lines + ["```json"] + examples + ["```", ""]


def rule_text(rule):
    def listed(names, word):
        return f" {word} ".join(f"`{name}`" for name in names)

    if "exactly_one" in rule:
        return f"Exactly one of {listed(rule['exactly_one'], 'and')}."
    if "at_most_one" in rule:
        return f"At most one of {listed(rule['at_most_one'], 'and')}."
    if "together" in rule:
        return f"Both {listed(rule['together'], 'and')} or neither."
    if "differ" in rule:
        return f"{listed(rule['differ'], 'and')} differ."
    if "beside" in rule:
        return f"{listed(rule['members'], 'and')} stand beside `{rule['beside']}` alone."
    return f"`{rule['normalised']}`: {rule['allowed']}."


def sections():
    lines = []
    for group in SPEC["groups"]:
        lines += [f"### {group['name']}", ""]
        if "text" in group:
            lines += textwrap.wrap(group["text"], 120) + [""]
        for operation in group["operations"]:
            lines += documented(operation)
    return "\n".join(lines)
