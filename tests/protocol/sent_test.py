"""What the server's code can send is what operations.json says: the codes of errors and notices, the kinds of events, and the
errors of each operation. Reads the sources: the calls that refuse, notify and tell, and which of them an operation reaches."""
import json
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPEC = json.loads((ROOT / "protocol" / "spec" / "operations.json").read_text())
OPERATIONS = [operation for group in SPEC["groups"] for operation in group["operations"]]

# An error's code is the first argument of what refuses, or stands before the path where an error is written out.
ERROR = re.compile(r'\b(?:refuse|refused)\(\s*(?:request,\s*)?"(\w+)"'
                   r'|\{\s*(?:(?:\{\}|std::nullopt),\s*)?"(\w+)",\s*(?:"(?:/\w*)?"|path|here\(\)),')
# What notices and events begin with: a name, or one of two.
NOTICE = re.compile(r'\b(?:notice_text\(|notices\.push_back\(\{)([^,]*),')
EVENT = re.compile(r"\b(?:events_\.add|balls_changed|pins_changed)\(([^,]*),")
FUNCTION = re.compile(
    r"^(?!namespace|struct|class|enum)([\w:<>,&*\s]+?[\s&*])(?:\w+::)*(\w+)\(([^;{}]*)\)[^;{}()]*\{(?:\n(.*?)^\}| (.*?) \}$)",
    re.M | re.S)


def sources(*folders):
    return {file: file.read_text() for folder in folders for file in sorted((ROOT / folder).glob("*.cpp"))}


def found(pattern, text):
    return {code for groups in pattern.findall(text) for code in groups if code}


def begun(pattern, text):
    """The names in what the pattern finds."""
    return {name for start in pattern.findall(text) for name in re.findall(r'"([\w.]+)"', start)}


def listed(kind):
    return {code for row in SPEC["server"][kind] for code in row["codes"]}


def camel(op):
    return "".join(word.capitalize() for word in re.split(r"[._]", op))


class Handlers:
    """The functions of server/host by name and, where they take a command, by its type."""

    def __init__(self):
        self.bodies, self.commands = {}, {}
        for text in sources("server/host").values():
            for kind, name, parameters, body, line in FUNCTION.findall(text):
                body = body or line
                command = re.match(r"(?:const Request& request, )?const protocol::(\w+)&", parameters)
                if name in ("carry_out", "answer") and command:
                    self.commands[command[1]] = body
                elif re.search(r"Error|Fault|Outcome", kind):
                    self.bodies.setdefault(name, []).append((parameters, body))

    def errors(self, command):
        """Codes that its handler, or a function that the handler calls for an error, names."""
        codes, waiting, seen = set(), [self.commands[command]], set()
        while waiting:
            body = waiting.pop()
            codes |= found(ERROR, body)
            for name in set(re.findall(r"\b(\w+)\(", body)) & set(self.bodies) - seen:
                seen.add(name)
                overloads = self.bodies[name]
                own = [each for parameters, each in overloads if f"protocol::{command}&" in parameters]
                waiting += own or [each for _, each in overloads]
        return codes


class Sent(unittest.TestCase):
    def test_codes_of_errors(self):
        sent = set().union(*(found(ERROR, text) for text in sources("protocol", "server/host", "server/net").values()))
        self.assertEqual(sent, listed("errors"))

    def test_codes_of_notices(self):
        text = "".join(sources("server/host", "server/net").values())
        self.assertEqual(begun(NOTICE, text), listed("notices"))

    def test_kinds_of_events(self):
        text = "".join(sources("server/host").values())
        self.assertEqual(begun(EVENT, text), {kind for event in SPEC["server"]["events"] for kind in event["kinds"]})

    def test_errors_of_each_operation(self):
        handlers = Handlers()
        for operation in OPERATIONS:
            with self.subTest(op=operation["op"]):
                said = {re.match(r"\w+", error)[0] for error in operation.get("errors", [])}
                self.assertEqual(handlers.errors(camel(operation["op"])), said)


if __name__ == "__main__":
    unittest.main()
