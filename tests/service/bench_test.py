"""`weft bench serve`: what it prints adds up, and it says when viewers could not join."""
import json
import pathlib
import re
import resource
import subprocess
import tempfile
import unittest

from serving import BINARY, GENEROUS, SCENES, Server
from tls_test import make_certificate


class Bench(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "load.json"

    def bench(self, server, *arguments, code=0, **options):
        done = subprocess.run([BINARY, "bench", "serve", f"http://127.0.0.1:{server.port}/", "--scene", "hung", "--json", self.file,
                               *map(str, arguments)], capture_output=True, text=True, timeout=2 * GENEROUS, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stdout, done.stderr

    def start(self, *arguments):
        server = Server(SCENES / "hung.json", *arguments)
        self.addCleanup(server.end)
        return server

    def test_prints_what_viewers_see_and_what_it_costs(self):
        server = self.start()
        out, _ = self.bench(server, "--viewers", 20, "--seconds", 2, "--mix", "50,25,25", "--slow", 10)
        told = json.loads(self.file.read_text())
        self.assertEqual(list(told), [line.split()[0] for line in out.splitlines()])
        self.assertEqual((told["viewers"], told["joined"], told["failures"]), (20, 20, 0))
        self.assertLessEqual(told["age_ms_p50"], told["age_ms_p95"])
        self.assertLessEqual(told["age_ms_p99"], told["age_ms_max"])
        self.assertGreater(told["fewest_per_second"], 0)
        self.assertLessEqual(told["most_per_second"], 70)  # 60 a second are made
        # A frame of level 4 has at least 64 bytes of header, and one of level 6 at most 24 bytes a node.
        self.assertGreater(told["megabytes_per_second"], told["frames_per_second"] * 64 / 1e6)
        self.assertLess(told["megabytes_per_second"], told["frames_per_second"] * 24 * 65 * 65 / 1e6)
        for cost in ("server_cores", "own_cores", "server_megabytes", "network_cores", "network_us_per_frame", "joining_seconds"):
            self.assertGreater(told[cost], 0)
        self.assertLess(told["network_cores"], told["server_cores"] + 0.1)  # a part of it; the two are read one after the other

    def test_takes_no_more_frames_than_asked_for(self):
        server = self.start()
        self.bench(server, "--viewers", 3, "--seconds", 3, "--rate", 10)
        self.assertLess(json.loads(self.file.read_text())["most_per_second"], 21)  # two may be on the way

    def test_says_who_could_not_join(self):
        server = self.start("--viewers", 2)
        out, _ = self.bench(server, "--viewers", 5, "--seconds", 0.5, code=1)
        told = json.loads(self.file.read_text())
        self.assertEqual((told["joined"], told["failures"]), (2, 3))
        self.assertRegex(out, r"first failure +the server refused: 503 the scene has no place for another viewer")

    def test_tls_is_measured_beside_no_tls(self):
        certificate, key = make_certificate(self.file.parent, "one")
        other, _ = make_certificate(self.file.parent, "other")
        server = self.start("--tls-certificate", certificate, "--tls-key", key)
        load = ("--viewers", 5, "--seconds", 1, "--tls")
        for trust in (("--ca", certificate), ("--unchecked",)):
            out, _ = self.bench(server, *load, *trust)
            told = json.loads(self.file.read_text())
            self.assertEqual([told[part]["joined"] for part in ("plain", "tls")], [5, 5])
            self.assertAlmostEqual(told["costs"]["tls_us_per_frame"],
                                   told["tls"]["network_us_per_frame"] - told["plain"]["network_us_per_frame"], places=9)
            self.assertRegex(out, r"With TLS:\nviewers +5\n")
            self.assertRegex(out, r"TLS costs:\ntls_joining_network_ms +-?[0-9.e-]+\n")
        self.assertRegex(self.bench(server, *load, "--ca", other, code=1)[1], "certificate verify failed")

    def test_bad_usage_and_nobody_there_are_told(self):
        server = self.start()
        self.assertRegex(self.bench(server, "--mix", "0,0,0", code=2)[1], "needs a share above 0")
        self.assertRegex(self.bench(server, "--viewers", 0, code=2)[1], "not in range 1")
        few = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (100, 100))}
        self.assertIn("69 are more than the 68 connections", self.bench(server, "--viewers", 69, code=2, **few)[1])
        server.end()
        self.assertRegex(self.bench(server, "--seconds", 1, code=1)[1], re.escape(f"127.0.0.1:{server.port}"))


if __name__ == "__main__":
    unittest.main()
