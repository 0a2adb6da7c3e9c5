"""The notebooks of the Python client, executed by a kernel against a real server."""
import os
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "protocol" / "clients" / "python"
sys.path.insert(0, str(ROOT / "tests" / "service"))
from serving import Server  # noqa: E402

import nbclient  # noqa: E402
import nbformat  # noqa: E402

LIMIT_S = 300  # for a cell: far beyond what any takes


class Notebooks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.server = Server("flag")
        self.addCleanup(self.server.end)
        self.environment = {**os.environ, "WEFT_URL": self.server.url("flag"), "PYTHONPATH": str(PACKAGE),
                            "PYTHONDONTWRITEBYTECODE": "1", "IPYTHONDIR": folder.name, "JUPYTER_RUNTIME_DIR": folder.name}

    def executed(self, name):
        """The outputs of the code cells, in order; a cell that raises fails the test."""
        notebook = nbformat.read(PACKAGE / "examples" / name, as_version=4)
        nbformat.validate(notebook)
        nbclient.NotebookClient(notebook, timeout=LIMIT_S, kernel_name="python3").execute(env=self.environment)
        return [cell.outputs for cell in notebook.cells if cell.cell_type == "code"]

    def test_flag(self):
        title, mesh, near, heights, hanging, closed = self.executed("flag.ipynb")
        self.assertIn("text/plain", title[0].data)
        # flag.json: level 5 between 3 m and 8 m, 2^5 cells along a side.
        self.assertEqual(mesh[0].data["text/plain"], "(5, (33, 33, 3), dtype('float32'))")
        for picture in (near, hanging):
            self.assertEqual(picture[0].data["image/svg+xml"].count("M"), 33 + 33)  # a line for each row and column
        measured = [float(height) for height in re.findall(r"([-+]\d+\.\d+) m$", heights[0].text, re.MULTILINE)]
        self.assertEqual(len(measured), 4)
        self.assertGreater(measured[3], measured[0] + 0.2)  # the stronger the wind, the less a flag of 1.6 m hangs down
        self.assertEqual(closed, [])

    def test_they_are_kept_without_outputs(self):
        for path in (PACKAGE / "examples").glob("*.ipynb"):
            for cell in nbformat.read(path, as_version=4).cells:
                self.assertFalse(cell.get("outputs") or cell.get("execution_count"), path)


if __name__ == "__main__":
    unittest.main()
