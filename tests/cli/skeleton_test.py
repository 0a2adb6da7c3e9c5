"""weft skeleton: what it lists, the colliders that it fits, and the preset that is made of them."""
import json
import math
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import unittest

from cli import CliTest, weft

PRESETS = pathlib.Path(__file__).resolve().parents[2] / "server" / "scene" / "presets"


class Skeleton(CliTest):
    def fit(self, *arguments):
        result = weft("skeleton", "fit", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)["colliders"]

    def test_lists_animations_and_nodes(self):
        result = weft("skeleton", "list", PRESETS / "walk.bvh")
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stdout.splitlines()
        self.assertEqual(lines[0], 'animation "": 5.5 s, sampled every 0.0333333 s')  # 166 frames at 30 Hz
        self.assertIn("LeftForeArm on LeftArm", lines)
        self.assertEqual(weft("skeleton", "list", "walk").stdout, result.stdout)  # the same, built in

    def test_the_preset_s_capsules_are_what_it_writes(self):
        preset = json.loads((PRESETS / "walker.json").read_text())
        command = re.search(r"`weft skeleton (fit [^`]*)`", preset["notes"][0])[1]
        result = weft("skeleton", *shlex.split(command))
        self.assertEqual(json.loads(result.stdout)["colliders"], preset["colliders"][:-1])

    def test_the_walk_is_what_its_program_writes(self):
        shutil.copy(PRESETS / "make_walk.py", self.folder)
        subprocess.run([sys.executable, self.folder / "make_walk.py"], check=True)
        self.assertEqual((self.folder / "walk.bvh").read_text(), (PRESETS / "walk.bvh").read_text())

    def test_scales_to_a_height(self):
        height = float(re.search(r"^height: (\S+)$", weft("skeleton", "list", "walk").stdout, re.MULTILINE)[1])
        arm = next(c for c in self.fit("walk", "--height", "1.8") if c["motion"]["node"] == "LeftForeArm")
        self.assertAlmostEqual(arm["motion"]["scale"], 1.8 / height, delta=1e-6)
        self.assertAlmostEqual(arm["length"], 26 * 1.8 / height, delta=1e-4)  # of 26 cm
        self.assertAlmostEqual(arm["radius"], 0.15 * arm["length"], delta=1e-4)
        self.assertAlmostEqual(math.hypot(*arm["orientation"]["quaternion"]), 1, delta=1e-4)

    def test_a_scene_of_the_file_beside_it_is_good(self):
        shutil.copy(PRESETS / "walk.bvh", self.folder)
        colliders = self.fit(self.folder / "walk.bvh", "--scale", 0.01, "--loop")
        scene = self.scene_file(json.dumps({"cloths": [{}], "colliders": colliders}))
        self.assertEqual(weft("check", scene).returncode, 0)

    def test_the_preset_s_cape_stays_on_the_figure(self):
        """A round by each method. What is pinned can run away by strain alone: nodes that the figure left behind or carried off would
        make links several times as long, and energies of joules. The cape of 0.35 kg walks at 1 m/s: 0.17 J."""
        for method in ("bdf2", "backward_euler", "xpbd", "symplectic_euler"):
            rows = self.stats("walker", "--level", 5, "--frames", 480, "--set", f"/integrator/type={method}")
            self.assertLess(max(float(row["max_strain"]) for row in rows), 0.5, method)
            self.assertLess(max(float(row["mean_strain"]) for row in rows), 0.01, method)
            self.assertLess(max(float(row["kinetic_energy"]) for row in rows), 1.0, method)

    def test_says_what_is_wrong(self):
        bad = self.folder / "bad.bvh"
        bad.write_text("HIERARCHY\nTREE")
        for arguments, code, message in (
                (("list", bad), 1, f'weft: {bad}: has "TREE" in line 2; must be "ROOT"\n'),
                (("list", self.folder / "none.glb"), 1,
                 f"weft: {self.folder / 'none.glb'}: cannot be read: No such file or directory\n"),
                (("fit", "walk", "--animation", "run"), 1, 'weft: walk: has no animation "run"\n'),
                (("fit", "walk", "--radius", "Tail=0.1"), 1, 'weft: walk: has no bone at a joint "Tail"\n')):
            result = weft("skeleton", *arguments)
            self.assertEqual((result.returncode, result.stderr), (code, message))
        for arguments in (("fit", "walk", "--radius", "Chest"), ("fit", "walk", "--thinnest", "0.5"),
                          ("fit", "walk", "--height", "2", "--scale", "1"), ()):
            self.assertEqual(weft("skeleton", *arguments).returncode, 2, arguments)


if __name__ == "__main__":
    unittest.main()
