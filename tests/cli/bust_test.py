"""A mesh from a file, of 5,000 triangles: the same bits on any number of threads, and what a missing file says."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

WEFT = os.environ["WEFT_BINARY"]
SCENES = pathlib.Path(__file__).resolve().parent / "scenes"


class Bust(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        shutil.copy(SCENES / "bust.json", self.folder)

    def weft(self, *arguments):
        return subprocess.run([WEFT, *map(str, arguments)], capture_output=True, text=True)

    def test_same_bits_on_any_number_of_threads(self):
        surface = subprocess.run([sys.executable, SCENES / "make_bust.py"], capture_output=True, check=True).stdout
        self.assertEqual(surface.count(b"\nf "), 5000)
        (self.folder / "bust.obj").write_bytes(surface)
        runs = [self.weft("run", self.folder / "bust.json", "--level", 5, "--frames", 60, "--threads", threads, "--hash")
                for threads in (1, 4)]
        self.assertEqual([run.returncode for run in runs], [0, 0])
        hashes = {run.stdout.splitlines()[-1] for run in runs}
        self.assertEqual(len(hashes), 1)
        self.assertRegex(hashes.pop(), "^[0-9a-f]{16}$")

    def test_without_its_file_the_scene_is_refused(self):
        done = self.weft("check", self.folder / "bust.json")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('/colliders/0/file: is "bust.obj", which cannot be read: No such file or directory', done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
