"""weft run --save and --from: a run in two parts is the run without the break, to the bit."""
import csv
import json
import unittest

from cli import CliTest, weft


def hash_of(result) -> str:
    return result.stdout.splitlines()[-1]


class GoingOn(CliTest):
    def save(self, scene="flag-gusts", *arguments):
        """The file of a run of 20 steps."""
        path = self.folder / "state.weftrec"
        self.run_ok(scene, "--frames", 20, "--level", 4, "--save", path, *arguments)
        return path

    def refused(self, *arguments) -> str:
        result = weft("run", *arguments)
        self.assertEqual((result.returncode, result.stdout), (1, ""))
        return result.stderr

    def test_two_parts_are_the_run_without_a_break(self):
        # Gusts, contact with balls and cloth, gas, tearing, paths: what is remembered from step to step differs.
        for scene in ("flag-gusts", "zheng2020-ball", "cushion", "paper-screen", "washing-line"):
            with self.subTest(scene):
                whole = self.run_ok(scene, "--frames", 50, "--level", 4, "--hash")
                self.assertEqual(hash_of(self.run_ok(scene, "--frames", 30, "--hash", "--from", self.save(scene))),
                                 hash_of(whole))

    def test_frames_count_on_and_the_level_stays(self):
        path = self.save()
        self.run_ok("flag-gusts", "--frames", 2, "--from", path, "--stats", self.folder / "s.csv",
                    "--out", self.folder / "m.csv")
        with open(self.folder / "s.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(row["frame"], row["level"]) for row in rows], [("20", "4"), ("21", "4"), ("22", "4")])
        self.assertEqual(float(rows[-1]["time"]), 22 / 60)
        with open(self.folder / "m.csv", newline="") as file:
            self.assertEqual({row["frame"] for row in csv.DictReader(file)}, {"20", "21", "22"})

    def test_another_level_may_be_asked_for(self):
        rows = self.stats("flag-gusts", "--frames", 1, "--from", self.save(), "--level", 5)
        self.assertEqual({row["level"] for row in rows}, {"5"})

    def test_goes_on_where_it_is_written_to(self):
        path = self.save()
        for _ in range(2):
            self.run_ok("flag-gusts", "--frames", 15, "--from", path, "--save", path)
        whole = self.run_ok("flag-gusts", "--frames", 50, "--level", 4, "--hash")
        self.assertEqual(hash_of(self.run_ok("flag-gusts", "--frames", 0, "--from", path, "--hash")), hash_of(whole))

    def test_values_that_were_set_belong_to_the_scene(self):
        path = self.save("flag-gusts", "--set", "/wind/speed=3")
        self.assertIn("it is of another scene by that name, or of other values (--set)",
                      self.refused("flag-gusts", "--from", path))
        self.run_ok("flag-gusts", "--frames", 1, "--from", path, "--set", "/wind/speed=3")

    def test_states_of_others_are_refused(self):
        path = self.save()
        self.assertEqual(self.refused("flag", "--from", path),
                         f"weft: {path}: cannot go on from it: it is of another scene, flag-gusts; this is flag\n")
        text = path.read_bytes()
        path.write_bytes(text[:-20])
        self.assertRegex(self.refused("flag-gusts", "--from", path), r"cannot go on from it: it is cut short at byte \d+\n$")
        path.write_bytes(text[:2000] + bytes([text[2000] ^ 1]) + text[2001:])
        self.assertRegex(self.refused("flag-gusts", "--from", path), r"cannot go on from it: it is damaged at byte \d+\n$")
        path.write_text("{}")
        self.assertEqual(self.refused("flag-gusts", "--from", path), f"weft: {path}: it is no recording of this format\n")

    def test_a_file_that_cannot_be_written_is_told_before_the_first_step(self):
        self.assertIn("no/state: cannot be written",
                      self.refused("flag", "--frames", 1000000, "--save", self.folder / "no" / "state"))

    def test_replay_tells_what_it_is(self):
        result = weft("replay", self.save(), "--validate")
        self.assertEqual(result.returncode, 0)
        self.assertIn("scene flag-gusts, 0 steps (0.000 s), 0 commands, 1 states", result.stdout)
        self.assertIn("simulated 0.333 s", result.stdout)


class Summary(CliTest):
    def test_json_tells_what_the_stats_tell(self):
        result = self.run_ok("curtain", "--frames", 20, "--level", 4, "--json", "--hash", "--stats", self.folder / "s.csv",
                             "--save", self.folder / "state")
        told = json.loads(result.stdout)
        self.assertEqual([told[key] for key in ("scene", "frames", "time")], ["curtain", 20, 20 / 60])
        self.assertEqual(told["files"], [str(self.folder / "s.csv"), str(self.folder / "state")])
        self.assertEqual(told["hash"], hash_of(self.run_ok("curtain", "--frames", 20, "--level", 4, "--hash")))
        self.assertEqual(told["guard"], {"redone": 0, "frozen": 0, "balls_stopped": 0, "crowded": 0})
        self.assertGreaterEqual(told["longest_ms"], told["mean_ms"])
        self.assertIn(told["longest_frame"], range(1, 21))
        (cloth,) = told["cloths"]
        self.assertEqual((cloth["name"], cloth["level"], cloth["rows"], cloth["cols"], cloth["frozen"]),
                         ("curtain", 4, 17, 17, False))
        with open(self.folder / "s.csv", newline="") as file:
            last = list(csv.DictReader(file))[-1]
        for key in ("max_strain", "max_compression", "mean_strain", "kinetic_energy", "potential_energy",
                    "nodes_in_contact", "substeps"):
            self.assertEqual(cloth[key], float(last[key]), key)

    def test_without_a_hash_there_is_none(self):
        self.assertNotIn("hash", json.loads(self.run_ok("flag", "--frames", 0, "--json").stdout))


if __name__ == "__main__":
    unittest.main()
