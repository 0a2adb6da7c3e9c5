"""The executable itself: exit codes, what run writes, check, and that the same run gives the same bytes."""
import csv
import json
import os
import pathlib
import pty
import re
import resource
import select
import signal
import struct
import subprocess
import tempfile
import time
import unittest

WEFT = os.environ["WEFT_BINARY"]
BAD_SCENES = pathlib.Path(os.environ["WEFT_BAD_SCENES"])
HASHES = pathlib.Path(__file__).with_name("hashes.json")
LIMIT_S = 120

PRESETS = ["flag", "flag-gusts", "curtain", "fan", "tablecloth", "silk", "round-table", "cape", "sail", "trampoline", "washing-line",
           "towel", "hide", "cushion", "pillow", "paper-screen", "swing",
           "zheng2020-wind", "zheng2020-distance", "zheng2020-ball"]


def weft(*arguments: str) -> subprocess.CompletedProcess:
    return subprocess.run([WEFT, *map(str, arguments)], capture_output=True, text=True, timeout=LIMIT_S)


class CliTest(unittest.TestCase):
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


class Outputs(CliTest):
    def test_all_formats_hold_the_start_and_each_step(self):
        self.run_ok("flag", "--frames", 3, "--level", 4, *[
            argument for name in ("m.obj", "m.pc2", "m.csv", "m.glb") for argument in ("--out", self.folder / name)])
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()),
                         ["m.csv", "m.glb", "m.pc2", "m_0000.obj", "m_0001.obj", "m_0002.obj", "m_0003.obj"])
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
                    x for extension in ("obj", "pc2", "csv", "glb") for x in ("--out", self.folder / f"{name}.{extension}")])
            names = [p.name[1:] for p in self.folder.iterdir() if p.name.startswith("a") and p.suffix != ".stats"]
            self.assertEqual(len(names), 21 + 3)
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


class ExitCodes(CliTest):
    def test_bad_usage_is_2(self):
        for arguments in ([], ["fly"], ["run"], ["run", "flag", "--frames", "-1"], ["run", "flag", "--level", "9"],
                          ["run", "flag", "--frames", "many"], ["run", "flag", "--colour"], ["check"],
                          ["check", "flag", "--list"]):
            result = weft(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertNotEqual(result.stderr, "", arguments)

    def test_threads_must_make_sense(self):
        for command in ("run", "serve"):
            for threads in ("0", "-1", "1025", "many"):
                result = weft(command, "flag", "--threads", threads)
                self.assertEqual(result.returncode, 2, f"{command} --threads {threads}")
                self.assertIn("--threads", result.stderr)

    def test_help_is_0(self):
        self.assertEqual(weft("run", "--help").returncode, 0)

    def test_bad_scenes_list_all_problems(self):
        files = sorted(BAD_SCENES.glob("*.json"))
        self.assertGreaterEqual(len(files), 20)
        for file in files:
            problems = file.with_suffix(".txt").read_text().splitlines()
            count = f"{len(problems)} problem" + ("" if len(problems) == 1 else "s")
            expected = f"weft: {file}: {count}\n" + "".join(f"  {problem}\n" for problem in problems)
            for command, code in (("run", 2), ("check", 1)):
                result = weft(command, file)
                self.assertEqual((result.returncode, result.stderr, result.stdout), (code, expected, ""), file.name)

    def test_missing_scene(self):
        result = weft("run", "no-such-scene")
        self.assertEqual(result.returncode, 2)
        self.assertIn("no-such-scene: No such file or directory (neither a file nor a preset; the presets are flag, ",
                      result.stderr)

    def test_bad_set(self):
        result = weft("run", "flag", "--set", "/wind/speed=fast")
        self.assertEqual(result.returncode, 2)
        self.assertIn('/wind/speed: is "fast"; must be a number from 0 to 100 m/s', result.stderr)

    def test_steps_that_go_bad_are_made_again_and_told(self):
        # One substep a frame is far beyond the stability limit of this stiffness.
        result = weft("run", "flag", "--frames", 200, "--level", 4, "--set", "/integrator/type=symplectic_euler",
                      "--set", "/integrator/substeps=1", "--out", self.folder / "m.csv")
        self.assertEqual(result.returncode, 0)
        *lines, counts = result.stderr.splitlines()
        # Told once in 60 steps at most, and counted.
        self.assertTrue(0 < len(lines) <= 1 + 200 // 60, lines)
        redone = int(re.match(r'^weft: flag: step guard: .*"redone":(\d+)', counts)[1])
        self.assertGreaterEqual(redone, len(lines))
        for line in lines:
            self.assertRegex(line, r"^weft: flag: step \d+ gave .*: made again (with|by) ")
        with open(self.folder / "m.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 201 * 17 * 17)
        for key in ("x", "y", "z", "vx", "vy", "vz"):
            self.assertFalse({row[key] for row in rows} & {"nan", "-nan", "inf", "-inf"}, key)

    def test_a_cloth_frozen_at_the_end_is_3(self):
        # Falls ever faster, by 1000 m/s a step, until that is beyond what is taken for motion (1e6 m/s): it is
        # stopped, stands still for a step, and falls anew. It is 10 km wide, as single precision must tell its nodes
        # apart where it is by then.
        falling = ("--level", 4, "--set", "/cloths/0/size=[10000, 10000]", "--set", "/time_step=0.1", "--set",
                   "/cloths/0/pins=[]", "--set", "/wind=null", "--set",
                   '/effects=[{"type": "gravity", "acceleration": [0, -10000, 0]}]')
        result = weft("run", "flag", "--frames", 1100, *falling)
        self.assertEqual(result.returncode, 0)
        frozen, thawed = (int(re.search(r"step (\d+)", line).group(1)) for line in result.stderr.splitlines()[:2])
        self.assertRegex(result.stderr, r"weft: flag: step \d+ gave a speed of .* \(at most 1e\+06\), smaller steps too: "
                                        r"it stands still and is tried again from time to time\n"
                                        r"weft: flag: moves again from step \d+ on, its own way\n"
                                        r'weft: flag: step guard: .*"frozen":1,')
        self.assertEqual(thawed, frozen + 2)
        self.assertEqual(weft("run", "flag", "--frames", frozen, *falling).returncode, 3)

    def test_outputs_that_cannot_be_written_are_1_before_the_first_step(self):
        for path, message in ((self.folder / "no" / "m.csv", "cannot be written"), (self.folder / "m.stl", "unknown extension")):
            result = weft("run", "flag", "--frames", 1000000, "--out", path)
            self.assertEqual(result.returncode, 1)
            self.assertIn(message, result.stderr)
        result = weft("run", "flag", "--frames", 1200, "--out", self.folder / "m.glb")
        self.assertEqual(result.returncode, 1)
        self.assertIn("holds at most 1200 frames; this run has 1201", result.stderr)


class Cost(CliTest):
    # Two levels, six frames: small enough for a budget that is nearly all left.
    QUICK = ("--levels", "3-4", "--duration", "0.1", "--budget", "30s")

    def cost(self, *arguments):
        result = weft("cost", "swing", *arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout

    def test_table_csv_and_page(self):
        out = self.cost(*self.QUICK, "--out", self.folder / "cost.html", "--csv", self.folder / "cost.csv")
        self.assertRegex(out, r"^swing: 6 frames, 0\.1 s simulated, one thread of .+\n")
        self.assertRegex(out, r"\nlevel 3: reference: BDF2 in double precision, .+\n")
        with open(self.folder / "cost.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        # bdf2 and backward_euler 13 settings each, xpbd 6, symplectic_euler 3; the scene's own, bdf2, is one of them.
        self.assertEqual(len(rows), 2 * 35)
        self.assertEqual({row["integrator"] for row in rows}, {"bdf2", "backward_euler", "xpbd", "symplectic_euler"})
        self.assertEqual({row["status"] for row in rows}, {"done"})
        for level in "34":
            of_level = [row for row in rows if row["level"] == level]
            self.assertEqual([row["present"] for row in of_level].count("1"), 1)
            fastest = min(of_level, key=lambda row: float(row["ms_per_frame"]))
            self.assertEqual(fastest["best"], "1")  # nothing is faster, so nothing beats it
            for row in of_level:
                for key in ("ms_per_frame", "rms_error", "max_error", "total_rms_error"):
                    self.assertGreater(float(row[key]), 0, key)
                self.assertLessEqual(float(row["rms_error"]), float(row["max_error"]))
        self.assertIn("weft cost swing --levels 3,4 --integrators bdf2,backward_euler,xpbd,symplectic_euler "
                      "--duration 0.1 --budget 30s", (self.folder / "cost.html").read_text())

    def test_integrators_are_those_named_and_the_scenes_own(self):
        self.cost("--levels", 3, "--duration", "0.1", "--integrators", "xpbd", "--csv", self.folder / "cost.csv")
        with open(self.folder / "cost.csv", newline="") as file:
            self.assertEqual([row["integrator"] for row in csv.DictReader(file)], ["bdf2"] + 6 * ["xpbd"])

    def test_effects(self):
        result = weft("cost", "--effects", "zheng2020-ball", "--levels", 4, "--duration", "0.5")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual([line.split("  ")[1] for line in result.stdout.splitlines()[2:]],
                         ["gravity", "damping", "paper_wind", "contact", "springs, integrator", "all"])

    def test_bad_usage_is_2(self):
        for arguments in ([], ["no-such-scene"], ["swing", "--levels", "9"], ["swing", "--levels", "5-4"],
                          ["swing", "--levels", "four"], ["swing", "--integrators", "rk4"], ["swing", "--budget", "0s"],
                          ["swing", "--duration", "0.001"], ["swing", "--duration", "1000"],
                          ["swing", "--effects", "--csv", "cost.csv"], ["swing", "--set", "/time_step=fast"]):
            result = weft("cost", *arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertNotEqual(result.stderr, "", arguments)

    def test_files_that_cannot_be_written_are_1_before_the_first_step(self):
        result = weft("cost", "swing", "--budget", "1h", "--csv", self.folder / "no" / "cost.csv")
        self.assertEqual(result.returncode, 1)
        self.assertIn("cannot be written", result.stderr)

    def test_no_run_within_the_budget_is_3(self):
        result = weft("cost", "swing", "--levels", 3, "--duration", "0.1", "--budget", "0.000001s")
        self.assertEqual(result.returncode, 3)
        self.assertIn("no run of swing stayed sound within the budget", result.stderr)


class FullDisk(CliTest):
    """What cannot be written whole is told, with exit code 1, and is not there."""

    def run_limited(self, *arguments):
        """With files of at most 4 KiB: beyond, writing fails as on a full disk, and needs no disk for it."""
        return subprocess.run([WEFT, *map(str, arguments)], capture_output=True, text=True, timeout=LIMIT_S,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)),
                              restore_signals=False)  # Python ignores SIGXFSZ

    def test_files_are_whole_or_not_there(self):
        run = ("run", "flag", "--frames", 100, "--level", 4)
        cost = ("cost", "swing", *Cost.QUICK)
        for arguments, name in ((run + ("--out",), "m.csv"), (run + ("--out",), "m.pc2"), (run + ("--out",), "m.glb"),
                                (run + ("--out",), "m.obj"), (run + ("--stats",), "s.csv"), (cost + ("--csv",), "c.csv")):
            with self.subTest(name):
                path = self.folder / name
                path.write_text("of an earlier run")
                result = self.run_limited(*arguments, path)
                written = self.folder / "m_0000.obj" if name == "m.obj" else path
                self.assertEqual((result.returncode, result.stderr), (1, f"weft: {written}: writing failed: File too large\n"))
                self.assertEqual(path.read_text(), "of an earlier run")
                path.unlink()
                self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_run_that_is_killed_leaves_what_was_there(self):
        path = self.folder / "m.csv"
        path.write_text("of an earlier run")
        process = subprocess.Popen([WEFT, "run", "flag", "--frames", "1000000", "--level", "4", "--out", path])
        part = self.folder / "m.csv.part"
        while not (part.exists() and part.stat().st_size > 0) and process.poll() is None:
            time.sleep(0.01)
        process.kill()
        process.wait()
        self.assertEqual(path.read_text(), "of an earlier run")

    def test_a_device_is_written_itself(self):
        for option in ("--stats", "--out"):
            link = self.folder / "m.csv"
            link.symlink_to("/dev/full")
            result = weft("run", "flag", "--frames", 3, "--level", 4, option, link)
            self.assertEqual((result.returncode, result.stderr),
                             (1, f"weft: {link}: writing failed: No space left on device\n"))
            link.unlink()
            link.symlink_to("/dev/null")
            self.run_ok("flag", "--frames", 3, "--level", 4, option, link)
            self.assertTrue(link.is_symlink())
            link.unlink()

    def test_a_file_that_may_not_be_written_stays(self):
        path = self.folder / "m.csv"
        path.write_text("of an earlier run")
        path.chmod(0o444)
        if os.access(path, os.W_OK):
            self.skipTest("root may write everything")
        result = weft("run", "flag", "--frames", 1, "--level", 4, "--out", path)
        self.assertEqual((result.returncode, result.stderr), (1, f"weft: {path}: cannot be written: Permission denied\n"))

    def test_standard_output_that_is_full_is_1(self):
        for arguments in (("run", "flag", "--frames", 1, "--level", 4, "--hash"), ("check", "flag"), ("check", "--list"),
                          ("version",), ("--help",), ("run", "--help")):
            with self.subTest(arguments), open("/dev/full", "w") as full:
                result = subprocess.run([WEFT, *map(str, arguments)], stdout=full, stderr=subprocess.PIPE, text=True,
                                        timeout=LIMIT_S)
                self.assertEqual((result.returncode, result.stderr),
                                 (1, "weft: standard output: writing failed: No space left on device\n"))

    def test_a_reader_that_goes_ends_it_as_unix_tools_end(self):
        reading, writing = os.pipe()
        os.close(reading)
        result = subprocess.run([WEFT, "check", "--list"], stdout=writing, stderr=subprocess.PIPE, timeout=LIMIT_S)
        os.close(writing)
        self.assertEqual((result.returncode, result.stderr), (-signal.SIGPIPE, b""))


class Set(CliTest):
    def test_changes_what_is_simulated(self):
        sheet = self.scene_file('{"cloths": [{}]}')  # 2 m x 2 m, 0.1 kg/m2, free; every rest length exact in binary
        still = self.stats(sheet, "--frames", 5, "--level", 4)
        self.assertEqual({row["kinetic_energy"] for row in still}, {"0"})  # nothing pushes it
        falling = self.stats(sheet, "--frames", 5, "--level", 4, "--set", '/effects=[{"type":"gravity"}]')
        self.assertAlmostEqual(float(falling[-1]["kinetic_energy"]), 0.4 / 2 * (9.81 * 5 / 60) ** 2, 6)  # m (g t)2 / 2


class Check(CliTest):
    def test_list(self):
        result = weft("check", "--list")
        self.assertEqual(result.returncode, 0)
        self.assertEqual([line.split()[0] for line in result.stdout.splitlines()], PRESETS)
        self.assertIn("Zheng 2020, Fig. 5", result.stdout)

    def test_presets_are_ok(self):
        for preset in PRESETS:
            result = weft("check", preset)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertTrue(result.stdout.startswith(f"{preset}: ok\n"))

    def test_file(self):
        result = weft("check", self.scene_file('{"cloths": [{"name": "towel", "pins": ["top"]}], "notes": "Why not."}'))
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stdout, "scene: ok\n  title: scene\n  note: Why not.\n"
                                        "  cloth towel: 2 x 2 m, 0.1 kg/m2, levels 4 to 6, at most 65 x 65 nodes, 1 pins\n"
                                        "  effects: none\n  time step: 0.0166667 s\n")


class Version(CliTest):
    def test_version(self):
        self.assertRegex(weft("version").stdout, r"^weft \d+\.\d+\.\d+, protocol weft\.v1\n$")


if __name__ == "__main__":
    unittest.main()
