"""weft fabric: the tables of textile tests, and materials from their numbers."""
import json
import tempfile
import unittest

from cli import weft


class Fabric(unittest.TestCase):
    def test_a_fabric_is_tested_and_compared(self):
        result = weft("fabric", "test", "stretch_wool", "--cells", "16", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        readings = json.loads(result.stdout)["stretch_wool"]
        measured = readings["bending_length_warp"]["measured"][0]
        self.assertIn("Feng", measured["source"])
        self.assertLessEqual(measured["range"][0], measured["range"][1])
        self.assertAlmostEqual(readings["stretch_weft"]["simulated"], 279 + 6.8, delta=5)  # its threads', and the shear's
        self.assertIn("too soft", readings["stretch_warp"]["why"])  # 82 N/m: six times its length

    def test_a_scenes_materials_are_tested(self):
        scene = {"cloths": [{"name": "mine", "material": {"structural": [8000, 4000], "shear": 0.01, "bending": 0}}]}
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(scene, file)
            file.flush()
            result = weft("fabric", "test", "--scene", file.name, "--cells", "16", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        readings = json.loads(result.stdout)["mine"]
        self.assertAlmostEqual(readings["stretch_warp"]["simulated"], 8000, delta=1)
        self.assertAlmostEqual(readings["stretch_weft"]["simulated"], 4000, delta=1)
        self.assertNotIn("measured", readings["drape"])

    def test_numbers_become_a_material(self):
        result = weft("fabric", "fit", "--density", "0.1", "--bending-length-warp", "0.02", "--shear-stiffness", "50")
        self.assertEqual(result.returncode, 0, result.stderr)
        block = json.loads(result.stdout)
        self.assertEqual(sorted(block), ["density", "rigidity", "shear"])
        self.assertAlmostEqual(block["rigidity"][0], 0.1 * 9.80665 * 0.02 ** 3)

    def test_a_files_numbers_count_where_no_option_says_otherwise(self):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump({"density": 0.1, "shear_stiffness": 50}, file)
            file.flush()
            result = weft("fabric", "fit", file.name, "--shear-stiffness", "70")
        self.assertEqual(json.loads(result.stdout), {"density": 0.1, "shear": 70})

    def test_wrong_numbers_are_named(self):
        result = weft("fabric", "fit", "--density", "0.1", "--emt-warp", "5")
        self.assertEqual(result.returncode, 2)
        self.assertIn("/emt_warp: is 5.0; must be a number from 0.0001 to 2", result.stderr)
        for text, why in [("", "not JSON"), ("[1]", "is not a JSON object of numbers"), ("[" * 17, "nested deeper than 16 levels"),
                          ('{"density": 1e999}', "/density: is 1e999; allowed: finite numbers")]:
            with self.subTest(text), tempfile.NamedTemporaryFile("w", suffix=".json") as file:
                file.write(text)
                file.flush()
                result = weft("fabric", "fit", file.name)
                self.assertEqual(result.returncode, 2)
                self.assertIn(why, result.stderr)
        self.assertIn("/nowhere.json: cannot be read: No such file", weft("fabric", "fit", "/nowhere.json").stderr)
        self.assertIn("at most 33554432 are allowed", weft("fabric", "fit", "/dev/zero").stderr)
        self.assertEqual(weft("fabric", "test", "tin").returncode, 2)


if __name__ == "__main__":
    unittest.main()
