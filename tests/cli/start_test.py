"""Where a cloth starts from a file that Weft wrote: the same places, at its own level and at others, and what is refused."""
import csv
import json
import pathlib
import struct
import unittest

from cli import CliTest, weft

FRAMES = 12
FORMATS = ("obj", "glb", "usda", "pc2", "mdd", "csv")


class Start(CliTest):
    def export(self, scene="tablecloth", level=4, frames=FRAMES, options=()):
        self.run_ok(scene, "--frames", frames, "--level", level, *options, *[
            argument for name in FORMATS for argument in ("--out", self.folder / f"drape.{name}")])

    def cloth(self, nodes, levels=None, **members) -> dict:
        return {"name": "cloth", "size": [2, 2], "levels": levels or {"min": 4, "max": 4}, "nodes": nodes, **members}

    def scene_of(self, *cloths) -> pathlib.Path:
        return self.scene_file(json.dumps({"cloths": list(cloths), "effects": [{"type": "gravity"}]}))

    def places(self, path, frame) -> list[tuple[float, ...]]:
        with open(path, newline="") as file:
            return [tuple(float(row[axis]) for axis in "xyz") for row in csv.DictReader(file) if row["frame"] == str(frame)]

    def started(self, *cloths) -> list[tuple[float, ...]]:
        """Where the nodes of a scene's one cloth are before its first step."""
        out = self.folder / "started.csv"
        self.run_ok(self.scene_of(*cloths), "--frames", 1, "--out", out)
        return self.places(out, 0)

    def assert_near(self, places, expected, metres):
        self.assertEqual(len(places), len(expected))
        worst = max(abs(a - b) for place, other in zip(places, expected) for a, b in zip(place, other))
        self.assertLessEqual(worst, metres)

    def problems(self, nodes, **members) -> str:
        result = weft("check", self.scene_of(self.cloth(nodes, **members)))
        self.assertNotEqual(result.returncode, 0)
        return result.stdout + result.stderr


class SamePlaces(Start):
    def test_every_format_gives_the_places_that_were_written(self):
        """Positions of about 1 m: .csv and .obj write all digits of a float; the others add two floats or have one: 2^-23 m each."""
        self.export()
        for frame in (0, 7, FRAMES):
            expected = self.places(self.folder / "drape.csv", frame)
            for name in FORMATS:
                nodes = {"file": f"drape_{frame:04}.obj"} if name == "obj" else {"file": f"drape.{name}", "frame": frame}
                with self.subTest(name=name, frame=frame):
                    self.assert_near(self.started(self.cloth({**nodes, "cloth": "tablecloth"} if name in ("obj", "glb", "usda") else nodes)),
                                     expected, 0 if name in ("csv", "obj") else 4 * 2**-23)

    def test_without_a_frame_it_is_the_last_and_a_time_means_the_nearest(self):
        self.export()
        last, fourth = (self.places(self.folder / "drape.csv", frame) for frame in (FRAMES, 4))
        for name in ("glb", "usda", "mdd", "csv"):
            nodes = {"file": f"drape.{name}"} | ({"cloth": "tablecloth"} if name in ("glb", "usda") else {})
            with self.subTest(name):
                self.assert_near(self.started(self.cloth(nodes)), last, 4 * 2**-23)
                self.assert_near(self.started(self.cloth({**nodes, "time": 4.3 / 60})), fourth, 4 * 2**-23)

    def test_more_frames_than_one_mesh_of_a_glb_has_and_a_cloth_far_away(self):
        """The frames of a long .glb are in several nodes; those of a cloth far away are told from a node's translation."""
        scene = self.scene_of({"name": "far", "size": [1, 1], "position": [5000, 0, 0], "levels": {"min": 3, "max": 3}})
        options = [argument for name in ("glb", "usda", "csv") for argument in ("--out", self.folder / f"drape.{name}")]
        self.run_ok(scene, "--frames", 150, *options)
        for frame in (0, 1, 59, 60, 61, 127, 128, 129, 150):
            expected = self.places(self.folder / "drape.csv", frame)
            for name in ("glb", "usda"):
                cloth = {"name": "far", "size": [1, 1], "levels": {"min": 3, "max": 3}, "nodes": {"file": f"drape.{name}", "frame": frame}}
                with self.subTest(name=name, frame=frame):
                    self.assert_near(self.started(cloth), expected, 2**-19)  # it falls by 30 m: a float's last digit there

    def test_each_of_several_cloths_by_its_name(self):
        scene = self.scene_of(*({"name": name, "size": [1, 1], "position": [x, 0, 0], "levels": {"min": 3, "max": 3}}
                                for name, x in (("left-1", -2), ("right", 2))))
        self.run_ok(scene, "--frames", 3, *[x for name in FORMATS for x in ("--out", self.folder / f"two.{name}")])
        for name, x in (("left-1", -2), ("right", 2)):
            for file in ("two_0003.obj", "two.glb", "two.usda", f"two-{name}.mdd"):
                with self.subTest(name=name, file=file):
                    places = self.started({"name": name, "size": [1, 1], "levels": {"min": 3, "max": 3}, "nodes": {"file": file}})
                    self.assertEqual([places[0][0], places[8][0]], [x - 0.5, x + 0.5])


class Levels(Start):
    def test_a_finer_cloth_has_the_means_between_and_a_coarser_one_the_shared_nodes(self):
        """Eq. 8 of the paper: a new node on an edge is the mean of its two ends; the shared nodes stay."""
        self.export()
        nodes = {"file": "drape.csv", "frame": 5}
        own = self.places(self.folder / "drape.csv", 5)
        fine = self.started(self.cloth(nodes, {"min": 4, "max": 5}))
        coarse = self.started(self.cloth(nodes, {"min": 3, "max": 3}))
        self.assertEqual([len(fine), len(coarse)], [33 * 33, 9 * 9])
        self.assert_near([fine[66 * r + 2 * c] for r in range(17) for c in range(17)], own, 1e-7)
        self.assert_near([fine[66 * r + 2 * c + 1] for r in range(17) for c in range(16)],
                         [tuple((a + b) / 2 for a, b in zip(own[17 * r + c], own[17 * r + c + 1])) for r in range(17) for c in range(16)], 1e-7)
        self.assert_near(coarse, [own[34 * r + 2 * c] for r in range(9) for c in range(9)], 0)


class Refused(Start):
    def test_what_does_not_fit_is_told(self):
        self.export()
        told = self.problems({"file": "drape.csv", "frame": 13})
        self.assertIn('/cloths/0/nodes/file: is "drape.csv", which has 13 frames, counted from 0, and no frame 13', told)
        told = self.problems({"file": "drape.mdd", "time": 2})
        self.assertIn("which has frames from 0 to 0.2 s, and none at 2 s", told)
        told = self.problems({"file": "drape.glb"})
        self.assertIn('which has no cloth "cloth"; "cloth" may name one of its meshes: "tablecloth", "ball-1"', told)
        told = self.problems({"file": "drape_0003.obj", "cloth": "tablecloth"}, base_cells=[2, 1])
        self.assertIn("which has a cloth of 17 x 17 nodes, while this one has 17 x 33 nodes at level 4", told)
        told = self.problems({"file": "drape.mdd"}, base_cells=[2, 1])
        self.assertIn("which has a cloth of 289 nodes, while this one has 17 x 33 nodes at level 4", told)
        self.assertIn("/nodes/1/rotation: is given", self.problems({"file": "drape.glb", "cloth": "ball-1"}))
        self.assertIn("has no samples of the mesh's points", self.problems({"file": "drape.usda", "cloth": "ball_1"}))
        self.assertIn("vertices that are no grid", self.problems({"file": "drape_0003.obj", "cloth": "ball-1"}))
        for nodes, expected in (
                ({"file": "drape.csv", "frame": 1, "time": 1}, "/cloths/0/nodes/time: is given beside frame"),
                ({"frame": 1}, "/cloths/0/nodes/file"),
                ({"file": "drape.csv", "frame": -1}, "/cloths/0/nodes/frame"),
                ({"file": "drape_0003.obj", "frame": 3}, "which is one frame"),
                ({"file": "drape.pc2", "time": 0.1}, "which has frames, and no times"),
                ({"file": "drape.txt"}, "which must be a .obj, .glb, .usda, .pc2, .mdd or .csv file"),
                ({"file": "../drape.csv"}, "must be a path within the scene file's folder"),
                ({"file": "/etc/passwd.csv"}, "must be a path within the scene file's folder"),
                ({"file": "none.csv"}, "cannot be read: No such file or directory")):
            with self.subTest(nodes=nodes):
                self.assertIn(expected, self.problems(nodes))

    def test_files_that_are_cut_off_or_nonsense_are_told(self):
        self.export(frames=3)
        for name in FORMATS:
            path = self.folder / ("drape_0003.obj" if name == "obj" else f"drape.{name}")
            whole = path.read_bytes()
            named = {"cloth": "tablecloth"} if name in ("obj", "glb", "usda") else {}
            for share in (0, 0.02, 0.1):  # all within the cloth's own part
                with self.subTest(name=name, share=share):
                    path.write_bytes(whole[:int(share * len(whole))])
                    self.assertIn("/cloths/0/nodes/file: is", self.problems({"file": path.name, **named}))
            with self.subTest(name):
                path.write_bytes(b"\0\xff{(," * 2000)
                self.assertIn("/cloths/0/nodes/file: is", self.problems({"file": path.name, **named}))

    def test_a_header_that_promises_more_than_there_is(self):
        (self.folder / "big.mdd").write_bytes(struct.pack(">2I", 2**32 - 1, 66049))
        self.assertIn("has 8 bytes; 4294967295 frames of 66049 points have", self.problems({"file": "big.mdd"}))
        (self.folder / "big.pc2").write_bytes(struct.pack("<12sIIffI", b"POINTCACHE2\0", 1, 2**31, 0, 1, 1))
        self.assertIn("has 2147483648 points; must have 1 to 66049", self.problems({"file": "big.pc2"}))


if __name__ == "__main__":
    unittest.main()
