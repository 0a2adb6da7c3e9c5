"""The recipes of protocol/clients/README.md and the examples of the other READMEs, run as they stand there against a real server."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CLIENTS = ROOT / "protocol" / "clients"
sys.path.insert(0, str(ROOT / "tests" / "service"))
from serving import Server  # noqa: E402

import numpy as np  # noqa: E402

MOST_LINES = 10  # of code
LIMIT_S = 120    # far beyond what any takes
ADDRESS = "127.0.0.1:8080"  # in the recipes
WIND = [(0.0, 2.0), (0.5, 8.0), (1.0, 4.5)]  # s, m/s


def recipes(language, document=CLIENTS / "README.md"):
    """The blocks of code in a language, by the heading above each; "" where none of the second rank is above."""
    sections = re.split(r"^## (.*)$", document.read_text(), flags=re.MULTILINE)
    named = zip([""] + sections[1::2], sections[0::2])
    return {name: block for name, text in named for block in re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)}


def numbers(output):
    """The numbers on each line."""
    return [[float(word) for word in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?", line)] for line in output.splitlines()]


class Recipes:
    """What each recipe must do; `language`, `package` and `command` say in which way."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.server = Server("flag")
        self.addCleanup(self.server.end)

    def run_recipe(self, name, served=True, environment=None, **where):
        code = recipes(self.language, **where)[name]
        self.assertLessEqual(len([line for line in code.splitlines() if line.strip()]), MOST_LINES)
        self.assertEqual(ADDRESS in code, served)
        program = self.folder / f"recipe.{self.suffix}"
        program.write_text(code.replace(ADDRESS, f"127.0.0.1:{self.server.port}"))
        done = subprocess.run([*self.command, program], cwd=self.folder, env={**self.environment, **(environment or {})}, capture_output=True, text=True,
                              timeout=LIMIT_S)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return numbers(done.stdout)

    def started_from(self, file):
        """Where the server puts the nodes of a cloth that starts from a file of the flag."""
        flag = {"name": "flag", "size": [1.8, 1.2], "levels": {"min": 6, "max": 6}, "nodes": {"file": file}}
        (self.folder / "again.json").write_text(json.dumps({"cloths": [flag], "effects": [{"type": "gravity"}]}))
        subprocess.run([os.environ["WEFT_BINARY"], "run", "again.json", "--frames", "1", "--out", "again.csv"], cwd=self.folder,
                       check=True, capture_output=True, timeout=LIMIT_S)
        rows = np.loadtxt(self.folder / "again.csv", delimiter=",", skiprows=1, usecols=(0, 4, 5, 6), dtype=np.float32)
        return rows[rows[:, 0] == 0, 1:]

    def test_the_readme(self):
        self.run_recipe("Drive it from a program", document=ROOT / "README.md")
        (written,) = self.folder.glob("seen.*")
        seen = written.read_text().replace("\n", ",")
        # flag.json: level 6 within 3 m: 65 x 65 nodes; 60 frames.
        expected = 3 * 65 * 65 if written.suffix == ".json" else 60 * 3
        self.assertEqual(len(seen.strip(",").split(",")), expected)

    def test_the_package_s_readme(self):
        self.run_recipe("", document=CLIENTS / self.package / "README.md")

    def test_follow_a_camera(self):
        # flag.json: levels 6, 5, 4 within 3 m, within 8 m, beyond; a level has 2^level cells along a side.
        nodes = {12: (4, 17, 17), 5: (5, 33, 33), 0.8: (6, 65, 65)}
        for distance, *told in self.run_recipe("Follow a camera"):
            self.assertEqual(tuple(told[:3]), nodes.pop(distance))
        self.assertEqual(nodes, {})

    def test_throw_balls(self):
        told = self.run_recipe("Throw balls")
        self.assertEqual(len(told), 3)
        for _, _, _, z in told:
            self.assertLess(z, 0.9)  # from 1 m at -5 m/s: on its way for half a second or until the cloth

    def test_drive_wind_from_data(self):
        (self.folder / "wind.csv").write_text("".join(f"{time},{speed}\n" for time, speed in WIND))
        told = self.run_recipe("Drive wind from data")
        self.assertEqual([speed for _, speed in told], [speed for _, speed in WIND])
        for (since, _), (time, _) in zip(told, WIND):
            self.assertGreaterEqual(since, time - 1e-9)


    def test_save_what_came(self):
        self.run_recipe("Save what came")
        lines = [line.split(" ") for line in (self.folder / "flag.obj").read_text().splitlines()]
        kinds = [kind for kind, *_ in lines]
        # flag.json: one cloth; who tells no camera sees it at its finest level, 6: 65 x 65 nodes, 64 x 64 faces.
        self.assertEqual([kinds.count(kind) for kind in ("o", "v", "vt", "vn", "f")], [1, 65 * 65, 65 * 65, 65 * 65, 64 * 64])
        self.assertEqual(lines[0], ["o", "flag"])
        nodes = np.array([numbers for kind, *numbers in lines if kind == "v"], np.float32)
        np.testing.assert_array_equal(self.started_from("flag.obj"), nodes)
        data = (self.folder / "flag.glb").read_bytes()
        self.assertEqual((data[:4], int.from_bytes(data[8:12], "little")), (b"glTF", len(data)))
        document = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])
        self.assertEqual(sum(1 + len(mesh.get("weights", [])) for mesh in document["meshes"]), 60)  # a shape a frame


class Python(Recipes, unittest.TestCase):
    language, package, suffix, command = "python", "python", "py", ["/usr/bin/python3"]
    environment = {**os.environ, "PYTHONPATH": str(CLIENTS / "python"), "PYTHONDONTWRITEBYTECODE": "1"}

    def test_all_are_tested(self):
        self.assertEqual(set(recipes("python")), {"", "Follow a camera", "Throw balls", "Drive wind from data", "Save what came",
                                                  "Batch runs", "Record a data set", "A cape on a walking figure"})

    def test_asyncio(self):
        (step, *shape), = self.run_recipe("")
        self.assertGreaterEqual(step, 0)
        self.assertEqual(shape[2], 3)

    def test_batch_runs(self):
        told = self.run_recipe("Batch runs")
        self.assertEqual([speed for speed, *_ in told], [1, 4, 8])
        lowest, _, highest = (y for _, _, y, _ in told)
        self.assertGreater(highest, lowest + 0.2)  # m: the stronger the wind, the less a flag of 1.6 m hangs down

    def test_a_cape_on_a_walking_figure(self):
        shutil.copy(ROOT / "server" / "scene" / "presets" / "walk.bvh", self.folder)
        os.symlink(os.environ["WEFT_BINARY"], self.folder / "weft")
        environment = {"PATH": f"{self.folder}:{os.environ['PATH']}"}
        told = self.run_recipe("A cape on a walking figure", served=False, environment=environment)
        self.assertEqual(told[0][:2], [300, 5])  # frames, s
        self.assertGreater((self.folder / "walk.glb").stat().st_size, 300 * 65 * 65 * 3)  # moves of 300 frames
        colliders = json.loads((self.folder / "walk.json").read_text())["colliders"]
        self.assertEqual(len(colliders), 22)  # joints of the figure, the hips and the chest with three bones

    def test_record_a_data_set(self):
        self.run_recipe("Record a data set")
        with np.load(self.folder / "flag.npz") as data:
            positions, velocities, time, wind, balls = (data[name] for name in ("positions", "velocities", "time", "wind", "balls"))
        self.assertEqual((positions.shape, positions.dtype), ((120, 33, 33, 3), np.float32))
        np.testing.assert_allclose(np.diff(time), 1 / 60, atol=1e-9)  # every step once
        self.assertTrue(np.isfinite(positions).all())
        central = (positions[2:].astype(float) - positions[:-2]) / (2 / 60)  # of frames at equal distances
        np.testing.assert_allclose(velocities[1:-1], central, atol=1e-5)
        np.testing.assert_array_equal(wind, np.broadcast_to([6, 0, 0], (120, 3)))
        self.assertEqual(balls.shape, (120, 0, 4))  # the flag has none


class JavaScript(Recipes, unittest.TestCase):
    language, package, suffix, command = "js", "js", "mjs", [os.environ.get("WEFT_NODE", "node")]
    environment = dict(os.environ)

    def setUp(self):
        super().setUp()
        modules = self.folder / "node_modules"
        shutil.copytree(CLIENTS / "js", modules / "weft-client", ignore=shutil.ignore_patterns("node_modules"))
        (modules / "ws").symlink_to(ROOT / "tests" / "node_modules" / "ws")

    def test_all_are_tested(self):
        self.assertEqual(set(recipes("js")), {"Follow a camera", "Throw balls", "Drive wind from data", "Save what came"})


if __name__ == "__main__":
    unittest.main()
