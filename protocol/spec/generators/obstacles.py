"""What may stand in a scene, by its shape: its definition in the JSON Schema of server messages, its type in the JavaScript
client (clients/js/types.js) and its row of PROTOCOL.md."""
import json

from .table import SPEC

OBSTACLES = SPEC["server"]["obstacles"]
VECTOR = {"$ref": "#/$defs/vector"}
LENGTH = {"type": "number", "exclusiveMinimum": 0}
#: of a member's kind: its schema and its type in JavaScript
KINDS = {
    "vector": (VECTOR, "Vector"),
    "length": (LENGTH, "number"),
    "lengths": ({"type": "array", "items": LENGTH, "minItems": 3, "maxItems": 3}, "Vector"),
    "count": ({"type": "integer"}, "number"),
    "turn": ({"type": "array", "items": {"type": "number"}, "minItems": 4, "maxItems": 4}, "[number, number, number, number]")}


def sentence(text):
    return text[:1].upper() + text[1:] + "."


def members_of_obstacle(obstacle):
    """Those of its shape alone, and how it is turned unless they tell."""
    members = list(obstacle["members"])
    if obstacle["turns"]:
        members.append({"name": "quaternion", "kind": "turn", "text": "from its own axes to the world's: w, x, y, z",
                        "example": [1, 0, 0, 0]})
    return members


def member_schema(member):
    schema = {"description": sentence(member["text"]), **KINDS[member["kind"]][0]}
    if "range" in member:
        schema.update({name: bound for name, bound in zip(("minimum", "maximum"), member["range"]) if bound is not None})
    return schema


def obstacle_schema():
    """Any of them, as `scene` has it."""
    def one(obstacle):
        shapes, members = obstacle["shapes"], members_of_obstacle(obstacle)
        properties = {"shape": {"const": shapes[0]} if len(shapes) == 1 else {"enum": shapes}}
        if obstacle["turns"]:  # a body
            properties["mass"] = {"description": "kg, if it can be thrown or flies.", **LENGTH}
        properties["friction"] = {"$ref": "#/$defs/friction"}
        properties["position"] = {"description": sentence(obstacle["position"]), **VECTOR}
        properties.update({member["name"]: member_schema(member) for member in members})
        return {"description": sentence(obstacle["solid"]), "type": "object", "properties": properties,
                "required": ["shape", "position"] + [member["name"] for member in members]}
    return {"oneOf": [one(obstacle) for obstacle in OBSTACLES]}


def obstacle_rows():
    """An example and what it is, of each."""
    def example(obstacle):
        members = {member["name"]: member["example"] for member in members_of_obstacle(obstacle)}
        whole = {"shape": obstacle["shapes"][0], "position": [0, 0, 0], **members}
        return f"`{json.dumps(whole, separators=(',', ':'))}`"
    return [(example(obstacle), obstacle["solid"] + obstacle.get("more", "")) for obstacle in OBSTACLES]


def obstacle_types():
    """The types of types.js."""
    lines = ["/**"]
    for obstacle in OBSTACLES:
        members = members_of_obstacle(obstacle)
        shapes = "|".join(f"'{shape}'" for shape in obstacle["shapes"])
        fields = ", ".join(f"{member['name']}: {KINDS[member['kind']][1]}" for member in members)
        mass = ", mass?: number" if obstacle["turns"] else ""
        lines += [f" * @typedef {{{{shape: {shapes}, position: Vector, {fields}{mass}}}}} {obstacle['name']}",
                  f" *   {obstacle['solid']}; position: {obstacle['position']}"]
        lines += [f" *   {member['name']}: {member['text']}" for member in members]
    names = "|".join(obstacle["name"] for obstacle in OBSTACLES)
    lines += [f" * @typedef {{({names}) & {{friction?: number}}}} Obstacle in `scene`; skip shapes that you do not know", " */"]
    return "\n".join(lines)
