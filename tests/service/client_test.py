"""`weft client` against `weft serve`."""
import csv
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import tempfile
import unittest

from serving import BINARY, GENEROUS, SCENES, Server

FRAME = re.compile(r"frame (\d+)  time ([\d.]+) s  level ([\d,]+)  nodes ([\d,]+)  bytes (\d+)")


def objects_of(path):
    """The vertices of each object of an OBJ file."""
    objects = {}
    for line in path.read_text().splitlines():
        word, *values = line.split()
        if word == "o":
            vertices = objects.setdefault(values[0], [])
        elif word == "v":
            vertices.append([float(value) for value in values])
    return objects


class Client(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(SCENES / "hung.json", SCENES / "still.json")
        cls.addClassCleanup(cls.server.end)

    def client(self, *arguments, url=None):
        return subprocess.run([BINARY, "client", url or self.server.url(), *map(str, arguments)],
                              capture_output=True, text=True, timeout=GENEROUS)

    def test_health(self):
        for url in [f"http://127.0.0.1:{self.server.port}/", f"http://127.0.0.1:{self.server.port}", self.server.url()]:
            done = self.client("--health", url=url)
            self.assertEqual((done.returncode, done.stdout), (0, "200 ok\n"))

    def test_prints_a_line_for_each_frame(self):
        done = self.client("--camera", 12, "--frames", 20)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        frames = [match.groups() for match in map(FRAME.fullmatch, done.stdout.splitlines()) if match]
        self.assertEqual(len(frames), 20)
        numbers = [int(number) for number, *_ in frames]
        self.assertEqual(numbers, sorted(numbers))
        self.assertEqual(frames[-1][2:4], ("4", "289"))
        for number, time, *_ in frames:
            self.assertAlmostEqual(float(time), int(number) / 60, delta=1e-4)

    def test_commands_from_flags(self):
        done = self.client("--scene", "hung", "--wind", "1,0,0,5", "--ball", "0,0.5,2,0.2", "--throw", "0,1,-6",
                           "--frames", 30, url=f"http://127.0.0.1:{self.server.port}/")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        said = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
        kinds = [message["kind"] for message in said if message["op"] == "event"]
        self.assertEqual(kinds, ["wind", "ball.add", "ball.throw"])

    def test_saves_what_it_sees(self):
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory)
            done = self.client("--camera", 12, "--eye", "0,0,1", "--frames", 1)
            self.assertNotEqual(done.returncode, 0)  # one of the two
            done = self.client("--quiet", "--seconds", 1, "--frames", 10, "--out", path / "seen.csv", "--out", path / "seen.obj",
                               "--out", path / "seen.glb", "--out", path / "seen.pc2")
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
            with open(path / "seen.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            frames = sorted({int(row["frame"]) for row in rows})
            self.assertLessEqual(len(frames), 10)
            last = [row for row in rows if int(row["frame"]) == frames[-1]]
            self.assertEqual(len(last), 33 * 33)  # 5 m away: level 5
            # The upper corners are pinned where the sheet begins: 2 m wide, centred.
            self.assertAlmostEqual(float(last[0]["x"]), -1, delta=1e-3)
            self.assertAlmostEqual(float(last[32]["x"]), 1, delta=1e-3)
            self.assertEqual((path / "seen.glb").read_bytes()[:4], b"glTF")
            self.assertEqual((path / "seen.pc2").read_bytes()[:11], b"POINTCACHE2")
            self.assertEqual(len(list(path.glob("seen*.obj"))), len(frames))

    def test_saves_the_bodies_as_a_run_does(self):
        """Vertices as `weft run` writes them, which has the shapes themselves; a mesh comes to a micrometre, places as floats."""
        square = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        scene = {
            "cloths": [{"levels": {"min": 3, "max": 3}, "position": [0, 3, 0], "pins": ["top"]}],
            "effects": [{"type": "gravity"}],
            "colliders": [
                {"type": "plane", "position": [0, -1, 0], "normal": [0.1, 1, 0]},
                {"type": "ball", "position": [0.1, 0.2, 0.3], "radius": 0.25},
                {"type": "box", "position": [1, 0, 0], "size": [0.1, 0.2, 0.3], "orientation": {"axis": [1, 1, 0], "degrees": 30}},
                {"type": "capsule", "position": [2, 0, 0], "radius": 0.1, "length": 0.5},
                {"type": "convex", "position": [3, 0, 0], "points": square},
                {"type": "mesh", "position": [4, 0, 0], "vertices": square, "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]},
                {"type": "box", "size": [1, 1, 1], "path": [{"time": 1000, "position": [5, 0, 0]}]}]}
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory)
            (path / "all.json").write_text(json.dumps(scene))
            subprocess.run([BINARY, "run", path / "all.json", "--frames", "1", "--out", path / "run.obj"], check=True, stdout=subprocess.DEVNULL)
            server = Server(path / "all.json")
            self.addCleanup(server.end)
            outputs = [argument for name in ("obj", "glb", "usda") for argument in ("--out", path / f"seen.{name}")]
            done = self.client("--quiet", "--ball", "0,5,0,0.5", "--frames", 3, *outputs, url=server.url("all"))
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            frames = sorted(path.glob("seen_*.obj"))
            self.assertEqual(len(frames), 3)
            run, seen = objects_of(path / "run_0000.obj"), objects_of(frames[-1])
            self.assertEqual(list(run), ["cloth", "ball-1"] + [f"obstacle-{i}" for i in range(6)])
            self.assertEqual(list(seen), ["cloth", "ball-1", "ball-2"] + [f"obstacle-{i}" for i in range(6)])
            for name in list(run)[1:]:
                self.assertEqual(len(seen[name]), len(run[name]), name)
                worst = max(abs(a - b) for mine, other in zip(seen[name], run[name]) for a, b in zip(mine, other))
                self.assertLessEqual(worst, 2e-6, name)
            heights = [y for _, y, _ in seen["ball-2"]]
            self.assertAlmostEqual(max(heights) - min(heights), 1, delta=1e-5)
            self.assertAlmostEqual((max(heights) + min(heights)) / 2, 5, delta=1e-5)  # kinematic
            glb = (path / "seen.glb").read_bytes()
            names = [node["name"] for node in json.loads(glb[20:20 + int.from_bytes(glb[12:16], "little")])["nodes"]]
            self.assertEqual(names, list(seen))
            usda = (path / "seen.usda").read_text()
            self.assertEqual(re.findall(r'def Mesh "(\w+)"', usda), [name.replace("-", "_") for name in seen])

    def test_recordings_that_cannot_be_written_are_1(self):
        with tempfile.TemporaryDirectory() as directory:
            for name in ["seen.csv", "seen.obj", "seen.glb", "seen.pc2"]:
                with self.subTest(name):
                    # Files of at most 4 KiB stand for a full disk.
                    done = subprocess.run([BINARY, "client", self.server.url(), "--frames", "3", "--quiet",
                                           "--out", f"{directory}/{name}"], capture_output=True, text=True, timeout=GENEROUS,
                                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)),
                                          restore_signals=False)  # Python ignores SIGXFSZ
                    self.assertEqual(done.returncode, 1)
                    self.assertRegex(done.stderr, r"\Aweft: \S+/seen\S+: writing failed: File too large\n\Z")
                    self.assertEqual(os.listdir(directory), [])

    def test_output_that_cannot_be_written_ends_it(self):
        with open("/dev/full", "w") as full:
            for more in [[], ["--health"]]:
                done = subprocess.run([BINARY, "client", self.server.url(), *more], stdout=full, stderr=subprocess.PIPE, text=True,
                                      timeout=GENEROUS)
                self.assertEqual(done.returncode, 1)
                self.assertRegex(done.stderr, r"\Aweft: standard output: writing failed.*\n\Z")

    def test_script(self):
        with tempfile.NamedTemporaryFile("w", suffix=".jsonl") as script:
            script.write('{"at": 0.3, "op": "camera", "distance": 0.5}\n'
                         '{"at": 0, "op": "camera", "distance": 20}\n\n'
                         '{"at": 0.1, "op": "ping", "id": 77, "t": 3}\n')
            script.flush()
            done = self.client("--script", script.name, "--seconds", 1)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        lines = done.stdout.splitlines()
        self.assertTrue(any('"re":77' in line and '"pong"' in line for line in lines), lines)
        levels = [match.group(3) for match in map(FRAME.fullmatch, lines) if match]
        self.assertIn("4", levels)
        self.assertEqual(levels[-1], "6")
        self.assertLess(levels.index("4"), levels.index("6"))

    def test_a_refused_command_is_an_error(self):
        done = self.client("--scene", "still", "--wind", "1,0,0,5", "--frames", 20, url=f"http://127.0.0.1:{self.server.port}/")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(json.loads(done.stderr)["code"], "unavailable")

    def test_behind_a_proxy_all_is_below_its_path(self):
        # The server has nothing there, and says so.
        for more, target in [(["--health"], "/cloth/"), (["--health"], "/cloth/v1/scenes/hung"), (["--frames", 1], "/cloth/")]:
            done = self.client(*more, url=f"http://127.0.0.1:{self.server.port}{target}")
            self.assertEqual(done.returncode, 1)
            self.assertIn("404 not found", done.stdout + done.stderr)

    def test_refusals_and_missing_servers(self):
        for arguments, words in [
                (["--scene", "attic", f"http://127.0.0.1:{self.server.port}/"], "the server refused: 404 there is no such scene"),
                (["http://127.0.0.1:1/"], "cannot connect to 127.0.0.1:1: Connection refused"),
                (["flag"], "not a URL"),
                (["--health", "http://127.0.0.1:1/"], "cannot connect")]:
            with self.subTest(arguments):
                done = subprocess.run([BINARY, "client", *arguments], capture_output=True, text=True, timeout=GENEROUS)
                self.assertEqual((done.returncode, done.stdout), (1, ""))
                self.assertEqual(len(done.stderr.splitlines()), 1)
                self.assertIn(words, done.stderr)

    def test_bad_scripts(self):
        for text in ["not json\n", '{"op": "pause"}\n', '{"at": "now", "op": "pause"}\n', '[1]\n', '{"at": 1}\n']:
            with self.subTest(text), tempfile.NamedTemporaryFile("w", suffix=".jsonl") as script:
                script.write(text)
                script.flush()
                done = self.client("--script", script.name)
                self.assertEqual(done.returncode, 1)
                self.assertIn(f"{script.name}:1: not a message like", done.stderr)

    def test_an_interrupted_client_completes_its_files(self):
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory) / "seen.glb"
            process = subprocess.Popen([BINARY, "client", self.server.url(), "--out", path], stdout=subprocess.PIPE, text=True)
            self.assertTrue(any(FRAME.match(line) for line in process.stdout))  # reads up to the first
            process.send_signal(signal.SIGINT)
            process.stdout.read()
            process.stdout.close()
            self.assertEqual(process.wait(GENEROUS), 0)
            length = int.from_bytes(path.read_bytes()[8:12], "little")
            self.assertEqual(length, path.stat().st_size)  # glTF 2.0: the header holds the file's length

    def test_a_server_that_stops_ends_it(self):
        with Server(SCENES / "hung.json") as server:
            process = subprocess.Popen([BINARY, "client", server.url()], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.assertTrue(any(FRAME.match(line) for line in process.stdout))
            server.terminate()
            _, complaint = process.communicate(timeout=GENEROUS)
            self.assertEqual(process.returncode, 1)
            self.assertEqual(complaint, "weft: the server closed the connection: 1001 the server stops\n")


if __name__ == "__main__":
    unittest.main()
