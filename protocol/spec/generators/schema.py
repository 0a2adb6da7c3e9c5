"""The JSON Schema of what clients send (schema/client.schema.json)."""
import json

from .table import BY, OPERATIONS, SPEC, is_required, members_of, type_of


def pretty(value, indent=0):
    """JSON text in which what fits into a line stands in one."""
    line = json.dumps(value, ensure_ascii=False)
    if len(line) + indent <= 118 or not isinstance(value, (dict, list)):
        return line
    inside = " " * (indent + 2)
    if isinstance(value, dict):
        items = [f"{json.dumps(name)}: {pretty(each, indent + 2)}" for name, each in value.items()]
    else:
        items = [pretty(each, indent + 2) for each in value]
    ends = "{}" if isinstance(value, dict) else "[]"
    return ends[0] + "\n" + ",\n".join(inside + item for item in items) + "\n" + " " * indent + ends[1]


def plain(text):
    return text[:1].upper() + text[1:] + "." if text and not text.endswith(".") else text


def schema_of_type(name):
    """Of a type by itself: what members refer to."""
    kind = type_of(name)
    schema = bounded(json.loads(json.dumps(kind["schema"])), kind)
    text = " ".join(part for part in [plain(kind.get("meaning", "")), kind.get("unit", "")] if part)
    return {"description": text, **schema} if text else schema


def bounded(schema, member):
    if "range" not in member or schema["type"] in ("string",):
        return schema
    low, high = (int(value) if float(value).is_integer() else value for value in member["range"])
    numbers = schema["items"] if schema["type"] == "array" else schema
    if "$ref" not in numbers:
        numbers.update({"minimum": low, "maximum": high})
    return schema


def schema_of_member(operation, member):
    shared = "is" in SPEC["types"][member["type"]] or member["type"] in ("text", "parameters")
    own = next(each for each in operation["members"] if each["name"] == member["name"])
    if shared and "range" not in own:
        schema = {"$ref": f"#/$defs/{member['type']}"}
    else:
        schema = bounded(json.loads(json.dumps(member["schema"])), member)
    unit = own.get("unit", "")
    text = ", ".join(part for part in [own.get("text", ""), unit] if part)
    if text:
        schema = {"description": plain(text), **schema}
    if "default" in member:
        schema["default"] = member["default"]
    for rule in operation.get("rules", []):
        if rule.get("normalised") == member["name"]:
            schema["not"] = {"items": {"const": 0}}
    return schema


def schema_of_operation(operation):
    members = members_of(operation)
    properties = {"op": {"const": operation["op"]}, "id": {"$ref": "#/$defs/id"}}
    properties.update({member["name"]: schema_of_member(operation, member) for member in members})
    schema = {
        "description": operation["summary"], "type": "object", "properties": properties,
        "required": ["op"] + [member["name"] for member in members if is_required(member)], "additionalProperties": False}
    dependent = {}
    for rule in operation.get("rules", []):
        if "exactly_one" in rule:
            schema["oneOf"] = [{"required": [name]} for name in rule["exactly_one"]]
        elif "at_most_one" in rule:
            schema["not"] = {"required": rule["at_most_one"]}
        elif "together" in rule:
            for name in rule["together"]:
                dependent.setdefault(name, []).extend(other for other in rule["together"] if other != name)
        elif "beside" in rule:
            for name in rule["members"]:
                dependent.setdefault(name, []).append(rule["beside"])
    if dependent:
        schema["dependentRequired"] = dependent
    return schema


def client_schema():
    ops = [operation["op"] for operation in OPERATIONS]
    shared = sorted({name for name, kind in SPEC["types"].items() if "is" in kind} | {"text", "parameters"})
    definitions = {operation["op"]: schema_of_operation(operation) for operation in OPERATIONS}
    definitions["id"] = {"description": "Asks for exactly one answer, which carries it as `re`.", "type": "integer",
                         "minimum": 1, "maximum": 2147483647}
    definitions.update({name: schema_of_type(name) for name in shared})
    schema = {
        "$schema": "https://json-schema.org/draft/2020-12/schema", "$id": "client.schema.json",
        "title": "Weft client message", "$comment": BY + ".",
        "description": "PROTOCOL.md section 2: JSON text from client to server. Unknown members are errors.",
        "type": "object", "required": ["op"], "properties": {"op": {"enum": ops}},
        "oneOf": [{"$ref": f"#/$defs/{op}"} for op in ops], "$defs": definitions}
    return pretty(schema) + "\n"
