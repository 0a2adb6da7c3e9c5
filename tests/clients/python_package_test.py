"""The Python package, installed into an empty environment: programs find it, speak to a real server, and are checked by mypy."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCE = ROOT / "protocol" / "clients" / "python"
sys.path.insert(0, str(ROOT / "tests" / "service"))
from serving import Server  # noqa: E402

LIMIT_S = 300  # far beyond what any command takes

PROGRAM = '''
import asyncio
import sys

import numpy as np
import numpy.typing as npt
import weft


def hang(url: str) -> npt.NDArray[np.float32]:
    with weft.open(url) as scene:
        told = scene.camera(distance=0.8)
        ball = scene.add_ball(np.array([0.8, 0, 1]), radius=0.1, motion="dynamic")
        scene.throw_ball(ball, (0, 1, -5))
        return scene.next_frame(lambda frame: frame.stamp.f >= told["f"]).cloths[0].positions


async def levels(url: str) -> list[int]:
    async with await weft.connect(url) as scene:
        async for frame in scene:
            return [cloth.level for cloth in frame.cloths]
    return []


print(weft.__file__)
print(hang(sys.argv[1]).shape)
print(len(asyncio.run(levels(sys.argv[1]))))
'''

WRONG = '''
import weft

with weft.open("ws://127.0.0.1:8080/v1/scenes/flag") as scene:
    scene.throw_ball("1", [0, 0, 1])
    scene.add_ball([0, 0, 0], 0.1, motion="flying")
    scene.next_frame().cloths[0].positions.append(1)
'''


def run(*command, **options):
    return subprocess.run([str(each) for each in command], capture_output=True, text=True, timeout=LIMIT_S, **options)


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.project = pathlib.Path(folder.name) / "project"
        cls.project.mkdir()
        source, environment = pathlib.Path(folder.name) / "source", pathlib.Path(folder.name) / "environment"
        shutil.copytree(SOURCE, source, ignore=shutil.ignore_patterns("__pycache__"))
        # numpy, websockets and setuptools are Debian's: nothing is fetched.
        cls.run_or_fail("/usr/bin/python3", "-m", "venv", "--system-site-packages", environment)
        cls.python = environment / "bin" / "python"
        cls.run_or_fail(cls.python, "-m", "pip", "install", "--no-index", "--no-build-isolation", "--no-deps", source)
        (cls.project / "program.py").write_text(PROGRAM)
        (cls.project / "wrong.py").write_text(WRONG)

    @staticmethod
    def run_or_fail(*command, **options):
        done = run(*command, **options)
        if done.returncode != 0:
            raise AssertionError(f"{command}: {done.stdout}{done.stderr}")
        return done.stdout

    def mypy(self, *arguments):
        return run("/usr/bin/mypy", "--strict", "--cache-dir", os.devnull, "--python-executable", self.python, *arguments, cwd=self.project)

    def test_a_program_in_an_empty_project(self):
        with Server("flag") as server:
            place, shape, cloths = self.run_or_fail(self.python, "program.py", server.url("flag"), cwd=self.project).splitlines()
        self.assertTrue(pathlib.Path(place).is_relative_to(self.python.parents[1]), place)
        self.assertEqual((shape, cloths), ("(65, 65, 3)", "1"))  # flag.json: level 6 within 3 m, one cloth

    def test_its_dependencies_are_there(self):
        self.run_or_fail(self.python, "-c", "import importlib.metadata as m; assert m.version('weft-client')")
        self.assertNotIn("weft-client", run(self.python, "-m", "pip", "check").stdout)

    def test_a_program_is_checked_by_its_types(self):
        done = self.mypy("program.py")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        wrong = self.mypy("wrong.py").stdout.splitlines()
        # One for each mistake, on its line of the file.
        self.assertEqual([line.split(":")[1] for line in wrong if ": error:" in line], ["5", "6", "7"], wrong)

    def test_the_package_is_clean(self):
        done = self.mypy("--config-file", SOURCE / "pyproject.toml", SOURCE / "weft")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
