"""weft run: what it writes and tells, the same bytes each time, levels, values that are set."""
import csv
import json
import os
import pathlib
import pty
import re
import select
import struct
import subprocess
import unittest

from cli import CliTest, LIMIT_S, WEFT, weft

HASHES = pathlib.Path(__file__).with_name("hashes.json")


class Outputs(CliTest):
    def test_all_formats_hold_the_start_and_each_step(self):
        self.run_ok("flag", "--frames", 3, "--level", 4, *[
            argument for name in ("m.obj", "m.pc2", "m.mdd", "m.csv", "m.glb", "m.usda") for argument in ("--out", self.folder / name)])
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()),
                         ["m.csv", "m.glb", "m.mdd", "m.pc2", "m.usda", "m_0000.obj", "m_0001.obj", "m_0002.obj", "m_0003.obj"])
        with open(self.folder / "m.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 4 * 17 * 17)
        self.assertEqual([rows[0][key] for key in ("frame", "time", "row", "col")], ["0", "0", "0", "0"])
        self.assertEqual([rows[-1][key] for key in ("frame", "row", "col")], ["3", "16", "16"])
        pc2 = (self.folder / "m.pc2").read_bytes()
        self.assertEqual(struct.unpack("<12siiffi", pc2[:32]), (b"POINTCACHE2\0", 1, 17 * 17, 0.0, 1.0, 4))
        self.assertEqual(len(pc2), 32 + 4 * 17 * 17 * 12)
        # One state, two formats: the last node of the last frame.
        last = struct.unpack("<3f", pc2[-12:])
        self.assertEqual([struct.unpack("<f", struct.pack("<f", float(rows[-1][k])))[0] for k in "xyz"], list(last))

    def test_same_run_gives_same_bytes(self):
        for scene in ("flag", "tablecloth", "zheng2020-ball"):
            for name in ("a", "b"):
                self.run_ok(scene, "--frames", 20, "--level", 5, "--stats", self.folder / f"{name}.stats", *[
                    x for extension in ("obj", "pc2", "mdd", "csv", "glb", "usda") for x in ("--out", self.folder / f"{name}.{extension}")])
            names = [p.name[1:] for p in self.folder.iterdir() if p.name.startswith("a") and p.suffix != ".stats"]
            self.assertEqual(len(names), 21 + 5)
            for name in names:
                self.assertEqual((self.folder / f"a{name}").read_bytes(), (self.folder / f"b{name}").read_bytes(), name)
            stats = []
            for name in ("a", "b"):
                with open(self.folder / f"{name}.stats", newline="") as file:
                    stats.append([{k: v for k, v in row.items() if k != "milliseconds"} for row in csv.DictReader(file)])
            self.assertEqual(stats[0], stats[1])
            self.assertEqual(len(stats[0]), 21)

    def test_ends_with_the_longest_step_and_tells_stretch_from_compression(self):
        result = self.run_ok("curtain", "--frames", 20, "--level", 4, "--stats", self.folder / "s.csv")
        with open(self.folder / "s.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        mean, longest, frame = re.search(r"([\d.]+) ms a frame, longest ([\d.]+) ms \(frame (\d+)\)", result.stdout).groups()
        self.assertGreaterEqual(float(longest), float(mean))
        self.assertIn(int(frame), range(1, 21))
        told = re.search(r"stretched by (\S+) % and compressed by (\S+) % at most\n", result.stdout).groups()
        for value, column in zip(told, ("max_strain", "max_compression")):
            self.assertAlmostEqual(float(value) / (100 * float(rows[-1][column])), 1, delta=0.051, msg=column)

    def test_frames_slower_than_real_time_are_counted(self):
        slow = self.run_ok("flag", "--frames", 20, "--level", 4, "--set", "/time_step=1e-6")  # a thousandth of what a step takes
        self.assertIn("20 of 20 frames took longer than real time, 0.001 ms\n", slow.stdout)
        told = json.loads(self.run_ok("flag", "--frames", 20, "--level", 4, "--set", "/time_step=1e-6", "--json").stdout)
        self.assertEqual(told["slow_frames"], 20)

    def test_several_cloths_have_files_and_rows_of_their_own(self):
        rows = self.stats("flag", "--frames", 1, "--level", 4, "--out", self.folder / "m.csv",
                          "--set", '/cloths/1={"name":"second","levels":{"min":3,"max":3}}')
        self.assertTrue((self.folder / "m-flag.csv").exists())
        self.assertTrue((self.folder / "m-second.csv").exists())
        self.assertEqual([(row["frame"], row["cloth"], row["level"]) for row in rows],
                         [("0", "flag", "4"), ("0", "second", "3"), ("1", "flag", "4"), ("1", "second", "3")])

    def test_threads_do_not_change_the_bytes(self):
        cloth = '{"name": "%s", "levels": {"min": 5, "max": 5}, "pins": ["top"], "position": [0, 0, %s]}'
        scene = self.scene_file('{"cloths": [%s], "effects": [{"type": "gravity"}]}'
                                % ", ".join(cloth % (name, z) for name, z in (("a", 0), ("b", 1), ("c", 2))))
        for threads in (1, 3):
            self.run_ok(scene, "--threads", threads, "--frames", 10, "--out", self.folder / f"on_{threads}.pc2")
        for cloth in "abc":
            self.assertEqual((self.folder / f"on_1-{cloth}.pc2").read_bytes(),
                             (self.folder / f"on_3-{cloth}.pc2").read_bytes())

    def test_hashes_of_the_last_state_are_those_of_the_table(self):
        # hashes.json: who changes the arithmetic on purpose writes them anew (tests/cli/write_hashes).
        table = json.loads(HASHES.read_text())
        for scene, expected in table["scenes"].items():
            for threads in (1, 2, 4, 8):
                with self.subTest(scene=scene, threads=threads):
                    result = self.run_ok(scene, *table["options"], "--threads", threads, "--hash")
                    self.assertEqual(result.stdout.splitlines()[-1], expected)

    def test_hash_tells_states_apart(self):
        hashes = [self.run_ok("flag", "--frames", frames, "--level", 4, "--hash", "--set", f"/wind/speed={speed}")
                  .stdout.splitlines()[-1] for frames, speed in ((3, 8), (4, 8), (3, 8.000001))]
        self.assertEqual(len(set(hashes)), 3)
        for text in hashes:
            self.assertRegex(text, "^[0-9a-f]{16}$")

    def test_no_progress_bar_without_a_terminal(self):
        self.assertEqual(self.run_ok("flag", "--frames", 5, "--level", 4).stderr, "")

    def test_progress_bar_on_a_terminal(self):
        master, slave = pty.openpty()
        self.addCleanup(os.close, master)
        process = subprocess.Popen([WEFT, "run", "flag", "--frames", "200", "--level", "4"], stderr=slave,
                                   stdout=subprocess.DEVNULL)
        os.close(slave)
        shown = b""
        while select.select([master], [], [], LIMIT_S)[0]:
            try:
                shown += os.read(master, 4096)
            except OSError:  # the other end is closed
                break
        self.assertEqual(process.wait(LIMIT_S), 0)
        self.assertIn(b"/200 frames", shown)


class Levels(CliTest):
    def level(self, *arguments) -> set[str]:
        return {row["level"] for row in self.stats("zheng2020-wind", "--frames", 2, *arguments)}

    def test_distance_chooses_the_level_by_eq_7(self):
        # Thresholds 1 and 10 m; a threshold itself belongs to the nearer band.
        for distance, level in ((0, "6"), (0.8, "6"), (1, "6"), (1.001, "5"), (5, "5"), (10, "5"), (10.001, "4"), (12, "4")):
            self.assertEqual(self.level("--distance", distance), {level}, distance)

    def test_level_is_taken_as_it_is(self):
        self.assertEqual(self.level("--level", 4), {"4"})

    def test_default_is_the_scenes_camera(self):
        self.assertEqual(self.level(), {"6"})
        self.assertEqual(self.level("--set", "/camera/distance=5"), {"5"})

    def test_levels_stay_within_the_cloths_limits(self):
        result = weft("run", "flag", "--frames", 1, "--level", 3)
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stderr, "weft: flag is at level 4, the nearest to 3 that it has\n")

    def test_level_and_distance_exclude_each_other(self):
        self.assertEqual(weft("run", "flag", "--level", 4, "--distance", 1).returncode, 2)


class Set(CliTest):
    def test_changes_what_is_simulated(self):
        sheet = self.scene_file('{"cloths": [{}]}')  # 2 m x 2 m, 0.1 kg/m2, free; every rest length exact in binary
        still = self.stats(sheet, "--frames", 5, "--level", 4)
        self.assertEqual({row["kinetic_energy"] for row in still}, {"0"})  # nothing pushes it
        falling = self.stats(sheet, "--frames", 5, "--level", 4, "--set", '/effects=[{"type":"gravity"}]')
        self.assertAlmostEqual(float(falling[-1]["kinetic_energy"]), 0.4 / 2 * (9.81 * 5 / 60) ** 2, 6)  # m (g t)2 / 2


if __name__ == "__main__":
    unittest.main()
