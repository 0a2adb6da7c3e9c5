"""weft cost: its table, its files, what it refuses."""
import csv
import unittest

from cli import CliTest, weft


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


if __name__ == "__main__":
    unittest.main()
