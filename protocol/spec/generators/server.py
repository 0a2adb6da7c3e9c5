"""What the server sends, of which operations.json has the names and meanings: the tables of PROTOCOL.md's section 3, and the
names in the JSON Schema of server messages (schema/server.schema.json), whose members, but for those of obstacles, are written
there by hand."""
import json

from .obstacles import obstacle_rows, obstacle_schema
from .schema import pretty
from .table import PROTOCOL, SPEC

SERVER = SPEC["server"]
SCHEMA = PROTOCOL / "schema" / "server.schema.json"


def codes(kind):
    """All of the table's `errors` or `notices`."""
    return [code for row in SERVER[kind] for code in row["codes"]]


def quoted(names):
    return ", ".join(f"`{name}`" for name in names)


def table(head, rows):
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    return "\n".join(lines + [f"| {' | '.join(row)} |" for row in rows])


def members_of_message(op):
    """The names that its schema has, besides `op`: those that are always there, and the others."""
    schema = json.loads(SCHEMA.read_text())["$defs"][op]
    names = [name for name in schema["properties"] if name != "op"]
    always = [name for name in names if name in schema["required"]]
    return always, [name for name in names if name not in always]


def overview():
    rows = []
    for message in SERVER["messages"]:
        always, sometimes = members_of_message(message["op"])
        rows.append((f"`{message['op']}`", message["summary"], quoted(always), quoted(sometimes) or "-"))
    rows.append(("`event`", "Something changed for all viewers, see below.", "`kind`, `f`", "those of its kind"))
    return table(("message", "says", "members", "may have"), rows)


def server_tables():
    """PROTOCOL.md's tables, each by the name in the marks around it."""
    tables = {message["op"]: table(("member", "meaning"), [(quoted(row["names"]), row["meaning"]) for row in message["members"]])
              for message in SERVER["messages"] if "members" in message}
    tables["messages"] = overview()
    tables["events"] = table(("kind", "members"), [(quoted(event["kinds"]), event["members"]) for event in SERVER["events"]])
    tables["obstacles"] = table(("shape", "solid is"), obstacle_rows())
    tables["notices"] = table(("code", "meaning"), [(quoted(row["codes"]), row["meaning"]) for row in SERVER["notices"]])
    tables["errors"] = table(("code", "when"), [(quoted(row["codes"]), row["when"]) for row in SERVER["errors"]])
    return tables


def server_schema():
    """The file with the table's names and meanings in it. A message without a schema, or the other way round, is an error."""
    schema = json.loads(SCHEMA.read_text())
    named = [(message["op"], message["summary"]) for message in SERVER["messages"]]
    named += [(event["name"], event["summary"]) for event in SERVER["events"]]
    if sorted(name for name, _ in named) != sorted(each["$ref"].split("/")[-1] for each in schema["oneOf"]):
        raise ValueError("operations.json and server.schema.json have different messages")
    definitions = schema["$defs"]
    for name, summary in named:
        definitions[name]["description"] = summary
    for event in SERVER["events"]:
        definitions[event["name"]]["properties"]["kind"]["enum"] = event["kinds"]
    definitions["obstacle"] = obstacle_schema()
    schema["oneOf"] = [{"$ref": f"#/$defs/{name}"} for name, _ in named]
    schema["properties"]["op"]["enum"] = [message["op"] for message in SERVER["messages"]] + ["event"]
    definitions["error"]["properties"]["code"]["enum"] = codes("errors")
    definitions["notice"]["properties"]["code"]["enum"] = codes("notices")
    return pretty(schema) + "\n"
