"""The commands in C++ (operations.h), and the table by which they are read (operations.cpp)."""
from .table import BY, OPERATIONS, is_required, meaning, members_of, number


def struct_name(operation):
    return "".join(word.capitalize() for part in operation["op"].split(".") for word in part.split("_"))


def cpp_value(member):
    value = member["default"]
    if isinstance(value, list):
        assert not any(value), "an array's default is zero, or no items"
        return ""
    return f"{member['cpp']}::{value}" if isinstance(value, str) else number(value)


def cpp_member(member):
    cpp = member["cpp"]
    if member.get("optional"):
        line = f"  std::optional<{cpp}> {member['name']} = {{}};"
    elif "default" in member:
        line = f"  {cpp} {member['name']}{{{cpp_value(member)}}};"
    else:
        line = f"  {cpp} {member['name']}{{}};"
    notes = [member.get("unit", ""), meaning(member)]
    comment = ", ".join(note for note in notes if note)
    return f"{line}  ///< {comment}" if comment else line


def cpp_header():
    structs = []
    for operation in OPERATIONS:
        body = "\n".join(cpp_member(member) for member in members_of(operation))
        structs.append(f"/// `{operation['op']}`: {operation['summary']}\n"
                       f"struct {struct_name(operation)} {{" + (f"\n{body}\n" if body else "") + "};")
    def listed(operations):
        return ",\n    ".join(struct_name(operation) for operation in operations)

    scene = [operation for operation in OPERATIONS if operation.get("scope") != "connection"]
    return f"""#pragma once
/// The commands of PROTOCOL.md section 2. {BY}.
// clang-format off
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocol/values.h"

namespace weft::protocol {{

{chr(10).join(structs)}

using Command = std::variant<
    {listed(OPERATIONS)}>;
/// Those that are a scene's to carry out; the others concern the connection.
using SceneCommand = std::variant<
    {listed(scene)}>;

}}  // namespace weft::protocol
"""


def cpp_field(operation, member):
    presence = "required" if is_required(member) else "optional"
    bounds = [number(value) for value in member.get("range", [])]
    if "unit" in member:
        bounds.append(f'"{member["unit"]}"')
    return (f'field<&{struct_name(operation)}::{member["name"]}>("{member["name"]}", Presence::{presence}, '
            f'{{{", ".join(bounds)}}})')


def cpp_rule(operation, rule):
    def quoted(names):
        return ", ".join(f'"{name}"' for name in names)

    if "exactly_one" in rule:
        return f'exactly_one(message, {quoted(rule["exactly_one"])})'
    if "at_most_one" in rule:
        return f'at_most_one(message, {quoted(rule["at_most_one"])})'
    if "together" in rule:
        return f'together(message, {quoted(rule["together"])})'
    if "differ" in rule:
        return f'differ(message, {quoted(rule["differ"])})'
    if "beside" in rule:
        return f'beside(message, {{{quoted(rule["members"])}}}, "{rule["beside"]}", "{rule["not_beside"]}")'
    name = rule["normalised"]
    return (f'normalised(message, "{name}", std::get<{struct_name(operation)}>(command).{name}, '
            f'"{rule["allowed"]}")')


def cpp_table():
    entries = []
    for operation in OPERATIONS:
        fields = ",\n       ".join(cpp_field(operation, member) for member in members_of(operation))
        entry = f'      {{"{operation["op"]}", Role::{operation["role"]}, {struct_name(operation)}{{}}, {{{fields}}}'
        rules = operation.get("rules", [])
        if rules:
            command = "command" if any("normalised" in rule for rule in rules) else ""
            lines = "".join(f"         if (Fault fault = {cpp_rule(operation, rule)}) return fault;\n" for rule in rules)
            entry += (f",\n       [](const json& message, Command&{' ' + command if command else ''}) -> Fault {{\n"
                      f"{lines}         return {{}};\n       }}")
        else:
            entry += ", nullptr"
        entries.append(entry + "},")
    return f"""// {BY}.
// clang-format off
#include "protocol/operation.h"

namespace weft::protocol {{

using nlohmann::json;

const std::vector<Operation>& operations() {{
  static const std::vector<Operation> table{{
{chr(10).join(entries)}
  }};
  return table;
}}

}}  // namespace weft::protocol
"""
