"""What a scene does not call for costs it nothing: it takes as many instructions a step, and as many bytes, as in a program that does
not contain it at all.

For each effect a scene with all others is stepped at level 5, by an implicit, a projective and an explicit method, by two programs, one
linked with everything and one without the effect's own object files (CMakeLists.txt), under callgrind; and a scene with nothing by a
program without any of them.
"""
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

PROGRAMS = dict(program.split("=") for program in os.environ["WEFT_STEP_PROGRAMS"].rstrip(",").split(","))
METHODS = ("bdf2", "xpbd", "symplectic_euler")  # in step.cpp's order
FRAMES = 2  # the first is backward Euler's where BDF2 is asked for


HELD = {"u": [0, 1], "v": [0, 0]}


def cloth(fields):
    """Heavy and soft, so that explicit substeps are few."""
    return {"size": [1, 1], "levels": {"min": 5, "max": 5},
            "material": {"density": 1, "structural": 50, "shear": 5, "bending": 0.5, "rigidity": 1e-6}, **fields}


def scene(absent, present=None):
    """A hung sheet with everything but what is absent; of cloth_contact, tearing and a seam only one goes, which `present` says."""
    if absent == "everything":
        return {"title": "hung", "effects": [], "cloths": [cloth({"pins": [HELD]})]}
    sewn = present in ("sewn", "gas")
    effects = [{"type": "gravity"}, {"type": "damping"}, {"type": "paper_wind"}, {"type": "aerodynamics"},
               {"type": "strain_damping", "time": 0.005}, {"type": "strain_limit"}, {"type": "plate_bending"},
               {"type": "inflation", **({"volume": 0.1} if present == "gas" else {})}]
    if not sewn:
        effects.append({"type": "tearing", "strength": 0.01} if present == "tearing" else {"type": "cloth_contact"})
    wind = {"speed": 3, "gusts": {"intensity": 0.2, "time_scale": 3}, "turbulence": {"intensity": 0.2, "length_scale": 0.5},
            "zones": [{"type": "sphere", "position": [0, 0, 0], "radius": 0.2, "velocity": [0, 0, 1]}]}
    gone = ("turbulence", "zones") if absent == "uneven_wind" else (absent,)
    balls = [{"type": "ball", "position": [0, 0, -0.15], "radius": 0.1}, {"type": "plane", "position": [0, -2, 0]}]
    if present == "bodies":
        balls[0]["motion"] = "dynamic"
    if present == "mesh_colliders":
        balls.append({"type": "mesh", "position": [0, 0, 0], "lathe": {"outline": [[0, -1], [0.2, -0.9], [0, -0.8]], "sides": 8}})
    pins = [dict(HELD)]
    if present == "moving_pins":
        pins[0]["path"] = [{"time": 0, "offset": [0, 0, 0]}, {"time": 1, "offset": [0.1, 0, 0]}]
    return {"title": "hung", "effects": [effect for effect in effects if effect["type"] != absent],
            "wind": {name: value for name, value in wind.items() if name not in gone},
            "colliders": [] if absent == "contact" else balls,
            "cloths": [cloth({"pins": pins, "sewn": sewn})]}


def measure(program, text, folder):
    """Instructions within Simulation::step, and bytes asked for, by each method."""
    file, out = folder / "scene.json", folder / "callgrind.out"
    file.write_text(text)
    run = subprocess.run(["valgrind", "--tool=callgrind", "--toggle-collect=weft::Simulation<float>::step()", "--dump-after=step_scene*",
                          f"--callgrind-out-file={out}", program, str(file), str(FRAMES)], check=True, capture_output=True, text=True)
    profiles = [folder / f"callgrind.out.{number}" for number in range(1, len(METHODS) + 1)]
    instructions = [int(re.search(r"^summary: (\d+)", profile.read_text(), re.MULTILINE)[1]) for profile in profiles]
    return list(zip(instructions, map(int, run.stdout.split()), strict=True))


class AbsentBuilds(unittest.TestCase):
    def test_a_program_without_an_effect_takes_as_many_instructions_and_bytes(self):
        whole = {}  # by scene: what is absent from a scene with all others anyhow leaves the same one
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for absent in sorted(set(PROGRAMS) - {"all"}):
                text = json.dumps(scene(absent))
                if text not in whole:
                    whole[text] = measure(PROGRAMS["all"], text, folder)
                without = measure(PROGRAMS[absent], text, folder)
                for method, (instructions, size), (with_it, with_it_size) in zip(METHODS, without, whole[text], strict=True):
                    with self.subTest(absent=absent, method=method):
                        print(f"{absent:15} {method:16} {instructions / FRAMES:10.0f} instructions a step without it, "
                              f"{with_it / instructions:.5f} times in the whole program; {size} bytes, {with_it_size - size} more")
                        self.assertGreater(instructions, 1e5 * FRAMES)  # something was stepped
                        self.assertAlmostEqual(with_it / instructions, 1, delta=1e-3)
                        self.assertEqual(with_it_size, size)

    def test_a_program_without_an_effect_cannot_simulate_it(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "scene.json"
            for absent in sorted(set(PROGRAMS) - {"all", "everything", "grab"}):
                with self.subTest(absent=absent):
                    file.write_text(json.dumps(scene(None, present=absent)))
                    run = subprocess.run([PROGRAMS[absent], str(file), "1"], capture_output=True, check=False)
                    self.assertLess(run.returncode, 0)  # ended by a signal


if __name__ == "__main__":
    unittest.main()
