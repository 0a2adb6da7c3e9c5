"""What a scene does not call for costs nothing: none of its functions is ever entered.

Each effect's or other part's scene is run under callgrind with it and without it. With it its class is entered, which shows that the test would see
it; without it neither the class nor a kernel of its own is. By an implicit, a projective and an explicit method: each has kernels of its own.
"""
import itertools
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

WEFT = os.environ["WEFT_BINARY"]
SCHEMA = pathlib.Path(__file__).resolve().parents[2] / "server" / "scene" / "scene.schema.json"

# Each method's own step.
METHODS = {"bdf2": "weft::Implicit<float>::advance", "xpbd": "weft::Xpbd<float>::advance",
           "symplectic_euler": "weft::SymplecticEuler<float>::advance"}
# Effect: its fields, and patterns of functions that are entered with it and never without it. A kernel's name
# without "clone" chooses among its instruction sets when the program is loaded.
EFFECTS = {
    "gravity": ({}, ["weft::Gravity<"]),
    "damping": ({}, ["weft::Damping<"]),
    "paper_wind": ({}, ["weft::PaperWind<", r"kernels::add_push.*clone"]),
    "aerodynamics": ({}, ["weft::Aerodynamics<", r"kernels::add_air_.*clone"]),
    "strain_damping": ({"time": 0.005}, [r"kernels::(add_(growth|strain)_damping|recall).*clone"]),
    "inflation": ({}, ["weft::Inflation<", r"kernels::add_pressure.*clone"]),
    "strain_limit": ({}, [r"kernels::\w*limit\w*<.*clone"]),
    "cloth_contact": ({}, [r"weft::(Layers|LayerContacts)<\w+>::", r"weft::(PatchTree|FeatureSearch|CollisionNet|SubstepNet)::"]),
    # Not in one scene with cloth_contact: in the other half of the list.
    "tearing": ({"strength": 0.01}, [r"weft::link_loads<", r"weft::Walls::", r"kernels::\w*torn\w*<.*clone"]),
    "plate_bending": ({}, [r"weft::Plate<\w+>::", r"kernels::(add|subtract|relax|project)_plate.*clone"]),
}

BALL = {"type": "ball", "position": [0, -0.2, 0.05], "radius": 0.1}
FLOOR = {"type": "plane", "position": [0, -0.35, 0]}
RING = {"type": "mesh", "position": [0, 0, -0.1], "lathe": {"outline": [[0, -0.1], [0.1, 0], [0, 0.1]], "sides": 8}}
# Part of a scene: functions that are entered with it and never without it. The parts of a group are in one scene.
PARTS = [
    {"seam": [r"weft::Seam<\w+>::"], "gas": [r"weft::Gas<\w+>::"], "moving pins": [r"weft::Pins<\w+>::(begin_step|carry)", "weft::along_path"]},
    {"mesh": [r"weft::(TriangleMesh|TriangleOctree)::", r"weft::closed_surface\("],
     "bodies": ["weft::BodyCollision::", r"weft::resolve\("],
     "wind zones": [r"kernels::blend_zone.*clone", "weft::NodeAir::"]},
]


def functions_entered(effects, folder, colliders=(), wind=None, cloth=None, method="bdf2"):
    """Names of all functions entered while a small hung sheet is stepped 6 times with these effects. It is heavy and soft, so that explicit
    substeps are few."""
    scene = {"title": "hung", "effects": effects, "integrator": {"type": method},
             "colliders": list(colliders),
             "cloths": [{"size": [1, 1], "pins": ["top_left"], "levels": {"min": 4, "max": 4},
                         "material": {"density": 1, "structural": 50, "shear": 5, "bending": 0.5, "rigidity": 1e-6}, **(cloth or {})}]}
    if any(effect["type"] in ("paper_wind", "aerodynamics") for effect in effects):
        scene["wind"] = {"speed": 3, **(wind or {})}
    file, out = folder / "scene.json", folder / "callgrind.out"
    file.write_text(json.dumps(scene))
    subprocess.run(["valgrind", "--quiet", "--tool=callgrind", f"--callgrind-out-file={out}", WEFT, "run", str(file), "--frames", "6",
                    "--level", "4"], check=True, stdout=subprocess.DEVNULL)
    return set(re.findall(r"^c?fn=\(\d+\) (.+)$", out.read_text(), re.MULTILINE))


class AbsentEffects(unittest.TestCase):
    def test_every_effect_of_the_schema_is_tested(self):
        effects = json.loads(SCHEMA.read_text())["properties"]["effects"]["items"]["oneOf"]
        self.assertEqual({effect["$ref"].split("/")[-1] for effect in effects}, set(EFFECTS))

    def test_none_is_entered_where_it_is_absent(self):
        # Two runs show all: one half of the effects, then the other.
        names = list(EFFECTS)
        with tempfile.TemporaryDirectory() as folder:
            for method, present in itertools.product(METHODS, (names[::2], names[1::2])):
                entered = functions_entered([{"type": name, **EFFECTS[name][0]} for name in present], pathlib.Path(folder), method=method)
                self.assertEqual({step for step in METHODS.values() if any(step in name for name in entered)}, {METHODS[method]})
                for name in names:
                    for mark in EFFECTS[name][1]:
                        seen = sorted(function for function in entered if re.search(mark, function))
                        with self.subTest(effect=name, mark=mark, present=present, method=method):
                            self.assertEqual(bool(seen), name in present, seen)

    def test_wind_that_varies_is_entered_only_where_it_does(self):
        kinds = {"gusts": ({"intensity": 0.2, "time_scale": 3}, "weft::GustSeries::"),
                 "turbulence": ({"intensity": 0.2, "length_scale": 0.5}, "weft::Eddies::"), None: (None, "weft::NodeAir::")}
        with tempfile.TemporaryDirectory() as folder:
            for present in kinds:
                entered = functions_entered([{"type": "aerodynamics"}], pathlib.Path(folder),
                                            wind={present: kinds[present][0]} if present else None)
                for kind, (_, mark) in kinds.items():
                    seen = sorted(function for function in entered if mark in function)
                    with self.subTest(kind=kind, present=present):
                        # The air at each node is needed for turbulence alone.
                        self.assertEqual(bool(seen), kind == present if kind else present == "turbulence", seen)

    def test_parts_are_entered_only_where_there_are_any(self):
        air = {"type": "aerodynamics"}
        path = [{"time": 0, "offset": [0, 0, 0]}, {"time": 1, "offset": [0, 0, 0.1]}]
        zone = {"type": "sphere", "position": [0, 0, 0], "radius": 0.2, "velocity": [0, 0, 1]}
        body = {"type": "box", "position": [0, -0.3, 0], "size": [0.1, 0.1, 0.1], "motion": "dynamic", "mass": 1}
        scenes = [([air, {"type": "gravity"}, {"type": "inflation", "volume": 0.1}], [BALL], {},
                   {"sewn": True, "pins": [{"u": [0, 1], "v": [0, 0], "path": path}]}),
                  ([air, {"type": "gravity"}, {"type": "inflation"}], [RING, FLOOR, body], {"zones": [zone]}, {})]
        with tempfile.TemporaryDirectory() as folder:
            for method, (here, (effects, colliders, wind, cloth)) in itertools.product(METHODS, zip(PARTS, scenes)):
                entered = functions_entered(effects, pathlib.Path(folder), colliders, wind, cloth, method)
                self.assertTrue(any("Contact<float>::" in name for name in entered), "nothing was touched")
                self.assertTrue(any(METHODS[method] in name for name in entered))
                for group in PARTS:
                    for part, marks in group.items():
                        for mark in marks:
                            seen = sorted(function for function in entered if re.search(mark, function))
                            with self.subTest(part=part, mark=mark, scene=list(here), method=method):
                                self.assertEqual(bool(seen), group is here, seen)

    def test_contact_is_entered_only_where_there_are_colliders(self):
        with tempfile.TemporaryDirectory() as folder:
            for colliders in ([], [{"type": "ball", "position": [0, -5, 0], "radius": 0.1}]):
                entered = functions_entered([{"type": "gravity"}], pathlib.Path(folder), colliders)
                for mark in ("weft::Contact<float>::", "weft::BroadPhase<float>::", "fcl::"):
                    seen = sorted(function for function in entered if re.search(mark, function))
                    with self.subTest(mark=mark, colliders=len(colliders)):
                        self.assertEqual(bool(seen), bool(colliders), seen)


if __name__ == "__main__":
    unittest.main()
