"""The executable, called by the tests of its commands."""
import csv
import os
import pathlib
import subprocess
import tempfile
import unittest

WEFT = os.environ["WEFT_BINARY"]
LIMIT_S = 120


def weft(*arguments: str) -> subprocess.CompletedProcess:
    return subprocess.run([WEFT, *map(str, arguments)], capture_output=True, text=True, timeout=LIMIT_S)


class CliTest(unittest.TestCase):
    """Has a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_ok(self, *arguments):
        result = weft("run", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def stats(self, *arguments) -> list[dict]:
        """The rows of --stats of a run."""
        self.run_ok(*arguments, "--stats", self.folder / "stats.csv")
        with open(self.folder / "stats.csv", newline="") as file:
            return list(csv.DictReader(file))

    def scene_file(self, text: str) -> pathlib.Path:
        path = self.folder / "scene.json"
        path.write_text(text)
        return path
