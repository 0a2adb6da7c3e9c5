"""The executable itself: exit codes, full disks, check, version."""
import csv
import os
import pathlib
import re
import resource
import signal
import subprocess
import time
import unittest

from cli import CliTest, LIMIT_S, WEFT, weft

BAD_SCENES = pathlib.Path(os.environ["WEFT_BAD_SCENES"])

PRESETS = ["flag", "flag-gusts", "curtain", "fan", "tablecloth", "silk", "round-table", "cape", "walker", "sail", "trampoline", "washing-line",
           "towel", "hide", "cushion", "pillow", "paper-screen", "swing",
           "zheng2020-wind", "zheng2020-distance", "zheng2020-ball"]


class ExitCodes(CliTest):
    def test_bad_usage_is_2(self):
        for arguments in ([], ["fly"], ["run"], ["run", "flag", "--frames", "-1"], ["run", "flag", "--level", "9"],
                          ["run", "flag", "--frames", "many"], ["run", "flag", "--colour"], ["check"],
                          ["check", "flag", "--list"]):
            result = weft(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertNotEqual(result.stderr, "", arguments)

    def test_what_was_meant_is_told(self):
        for arguments, meant in ((["run", "flag", "--frame", "3"], 'weft: --frame is unknown; did you mean "--frames"?\n'),
                                 (["run", "flag", "--sets=/a=1"], 'weft: --sets is unknown; did you mean "--set"?\n'),
                                 (["rum", "flag"], 'weft: rum is unknown; did you mean "run"?\n'),
                                 (["run", "flga"], 'did you mean "flag"?)\n'),
                                 (["run", "flag", "--set", "/wind/sped=3"],
                                  '/wind/sped: unknown key; known here: direction, speed, gusts, turbulence, zones; '
                                  'did you mean "speed"?\n')):
            result = weft(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertTrue(result.stderr.endswith(meant), result.stderr[-300:])
        self.assertNotIn("did you mean", weft("run", "flag", "--colour").stderr)

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
        result = weft("run", "flag", "--frames", 1000000, "--level", 5, "--out", self.folder / "m.glb")
        self.assertEqual(result.returncode, 1)
        self.assertIn("m.glb: a .glb holds at most 4 GiB", result.stderr)


class FullDisk(CliTest):
    """What cannot be written whole is told, with exit code 1, and is not there."""

    def run_limited(self, *arguments):
        """With files of at most 4 KiB: beyond, writing fails as on a full disk, and needs no disk for it."""
        return subprocess.run([WEFT, *map(str, arguments)], capture_output=True, text=True, timeout=LIMIT_S,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)),
                              restore_signals=False)  # Python ignores SIGXFSZ

    def test_files_are_whole_or_not_there(self):
        run = ("run", "flag", "--frames", 100, "--level", 4)
        cost = ("cost", "swing", "--levels", "3-4", "--duration", "0.1", "--budget", "30s")
        for arguments, name in ((run + ("--out",), "m.csv"), (run + ("--out",), "m.pc2"), (run + ("--out",), "m.glb"),
                                (run + ("--out",), "m.mdd"), (run + ("--out",), "m.usda"),
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

    def test_a_file_is_named_alone_from_its_folder(self):
        file = self.scene_file('{"cloths": [{}]}')
        result = subprocess.run([pathlib.Path(WEFT).resolve(), "check", file.name], cwd=self.folder, capture_output=True, text=True,
                                timeout=LIMIT_S)
        self.assertEqual((result.returncode, result.stderr), (0, ""))


class Version(CliTest):
    def test_version(self):
        self.assertRegex(weft("version").stdout, r"^weft \d+\.\d+\.\d+, protocol weft\.v1\n$")


if __name__ == "__main__":
    unittest.main()
