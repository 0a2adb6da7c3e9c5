"""Where the options of `weft serve` come from: the command line, the environment, a file."""
import json
import os
import pathlib
import re
import select
import subprocess
import tempfile
import unittest

WEFT = os.environ["WEFT_BINARY"]
LIMIT_S = 30


class Config(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def weft(self, *arguments, code=0, **variables):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("WEFT_")} | variables
        done = subprocess.run([WEFT, *map(str, arguments)], capture_output=True, text=True, timeout=LIMIT_S, env=environment)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr if code else done.stdout

    def file(self, text):
        path = self.folder / "weft.toml"
        path.write_text(text)
        return path

    def lines(self, *arguments, **variables):
        """By option: its value and its source."""
        text = self.weft("config", "print", *arguments, **variables)
        return dict(re.findall(r"^([a-z-]+) = (.*  # .*)$", text, re.MULTILINE))

    def test_the_command_line_goes_before_the_environment_and_that_before_the_file(self):
        file = self.file('port = 1\nviewers = 2\nballs = 3\nhost-name = ["a.example", "b.example"]\ninsecure = true\n')
        lines = self.lines("--config", file, "--port", 11, WEFT_PORT="21", WEFT_VIEWERS="22", WEFT_ALLOW_ORIGIN="https://a;https://b")
        self.assertEqual(lines["port"], "11  # --port")
        self.assertEqual(lines["viewers"], "22  # WEFT_VIEWERS")
        self.assertEqual(lines["balls"], f"3  # {file}")
        self.assertEqual(lines["host-name"], f'["a.example", "b.example"]  # {file}')
        self.assertEqual(lines["allow-origin"], '["https://a", "https://b"]  # WEFT_ALLOW_ORIGIN')
        self.assertEqual(lines["insecure"], f"true  # {file}")
        self.assertEqual(lines["grabs"], "64  # default")

    def test_what_is_printed_is_a_file_that_means_the_same(self):
        arguments = ["flag", "curtain", "--port", 11, "--host-name", "a.example", "--host-name", "b.example", "--insecure", "--set",
                     '/wind/speed=8', "--set", '/title="#1"', "--tokens", self.folder / "a#'b.json", "--log", "json"]
        arguments[-3].write_text("{}")
        values = {name: value.split("  # ")[0] for name, value in self.lines(*arguments).items()}
        again = self.lines("--config", self.file(self.weft("config", "print", *arguments)))
        self.assertEqual({name: value.split("  # ")[0] for name, value in again.items()}, values)

    def test_what_cannot_be_used_is_named_with_its_value(self):
        for text, words in [("prt = 7", "prt is unknown; allowed: scene, host, port"), ("port = 70000", "port is 70000"),
                            ("viewers = 0", "viewers is 0"), ("insecure = 'maybe'", "insecure is maybe; .*true or false"),
                            ("port = [1, 2]", "port is 1, 2"), ("[serve]\nport = 1", "line 1, column 1: serve must be a value"),
                            ("port = 1 2", "line 1, column "), ('tokens = "/none"', "tokens is /none"), ("log = 'xml'", "log is xml")]:
            with self.subTest(text):
                told = self.weft("config", "print", "--config", self.file(text), code=2)
                self.assertRegex(told, words)
                self.assertIn("weft.toml", told)
                self.assertEqual(told.count("\n"), 1)
        self.assertRegex(self.weft("serve", code=2, WEFT_PORT="x"), "WEFT_PORT: port is x")
        self.assertRegex(self.weft("config", "check", "--config", self.file(""), "none-such", code=1), "none-such")
        for one, other in (("certificate", "key"), ("key", "certificate")):
            told = self.weft("config", "check", "flag", f"--tls-{one}", self.file(""), code=1)
            self.assertIn("belong together", told)

    def test_limits_are_those_that_the_server_tells(self):
        given = {"message-bytes": 2000, "json-depth": 5, "messages-per-second": 7, "balls": 2, "grabs": 3, "viewers": 4, "frame-bytes": 5000}
        lines = self.lines(*[word for name, value in given.items() for word in (f"--{name}", value)])
        for name, value in given.items():
            self.assertEqual(lines[name], f"{value}  # --{name}")

    def test_a_log_in_json_is_an_object_a_line(self):
        server = subprocess.Popen([WEFT, "serve", "flag", "--port", "0", "--log", "json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  text=True)
        try:
            self.assertTrue(select.select([server.stdout], [], [], LIMIT_S)[0])
            server.stdout.readline()
        finally:
            server.terminate()
            _, log = server.communicate(timeout=LIMIT_S)
        lines = [json.loads(line) for line in log.splitlines()]
        self.assertIn("1 scenes", lines[0]["message"])
        self.assertEqual(lines[-1]["message"], "stopped")
        for line in lines:
            self.assertEqual(list(line), ["time", "level", "message"])
            self.assertRegex(line["time"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}[+-]\d\d:\d\d$")


if __name__ == "__main__":
    unittest.main()
