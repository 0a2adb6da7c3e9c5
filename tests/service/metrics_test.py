"""What the server tells those who run it: /metrics and /readyz."""
import json
import pathlib
import re
import tempfile
import time
import unittest

from serving import GENEROUS, ROOT, SCENES, Server

import weft

SAMPLE = re.compile(r'([a-z_]+)(?:\{(.*)\})? (-?[0-9.e+-]+|NaN|[+-]Inf)')
LABEL = re.compile(r'([a-z_]+)="([^"]*)"')


def samples(text):
    """Value by name and labels, of Prometheus' text format; every line of it is one, or a comment."""
    found = {}
    for line in text.splitlines():
        if line.startswith("# "):
            continue
        match = SAMPLE.fullmatch(line)
        assert match, line
        found[match[1], tuple(sorted(LABEL.findall(match[2] or "")))] = float(match[3])
    return found


class Metrics(unittest.IsolatedAsyncioTestCase):
    def start(self, *arguments):
        server = Server(SCENES / "hung.json", SCENES / "still.json", *arguments)
        self.addCleanup(server.end)
        return server

    def value(self, server, name, **labels):
        status, headers, body = server.get("/metrics")
        self.assertEqual(status, 200)
        self.assertTrue(headers["content-type"].startswith("text/plain; version=0.0.4"))
        return samples(body.decode()).get((name, tuple(sorted(labels.items()))), 0)

    def until(self, server, wanted, name, **labels):
        end = time.monotonic() + GENEROUS
        while not wanted(value := self.value(server, name, **labels)):
            self.assertLess(time.monotonic(), end, f"{name} is {value}")
        return value

    async def test_counts_what_scenes_and_viewers_do(self):
        server = self.start()
        self.assertEqual(self.value(server, "weft_step_seconds_count", scene="hung"), 0)
        async with await weft.connect(server.url(), timeout=GENEROUS) as near, await weft.connect(server.url(), timeout=GENEROUS) as far:
            await near.camera(distance=0.5)  # level 6 and level 4 by Table 1
            await far.camera(distance=12)
            frames = [await near.next_frame() for _ in range(30)]
            for code, send in [("not_found", lambda: near.remove_ball(77)), ("range", lambda: near.send("step", count=-1))]:
                with self.assertRaises(weft.WeftError):
                    await send()
                self.assertEqual(self.value(server, "weft_refused_commands_total", code=code), 1)
            for level, viewers in [("4", 1), ("5", 0), ("6", 1)]:
                self.until(server, lambda value, viewers=viewers: value == viewers, "weft_scene_viewers", scene="hung", level=level)
            self.until(server, lambda value: 0.5 < value < 1.5, "weft_clock_ratio", scene="hung")
            self.assertEqual(self.value(server, "weft_viewers"), 2)
            self.assertGreaterEqual(self.value(server, "weft_connections"), 2)
            self.assertGreaterEqual(self.value(server, "weft_sent_frames_total"), len(frames))
            # The smallest frame is the far viewer's: 17 x 17 nodes of at least three bytes and a header of 64 bytes.
            self.assertGreater(self.value(server, "weft_sent_frame_bytes_total"), len(frames) * (64 + 3 * 17 * 17))
            steps = self.value(server, "weft_step_seconds_count", scene="hung")
            self.assertGreaterEqual(steps, frames[-1].stamp.f)
            self.assertGreater(self.value(server, "weft_step_seconds_sum", scene="hung"), 0)
            self.assertGreaterEqual(self.value(server, "weft_step_seconds_bucket", scene="hung", le="+Inf"), steps)
            self.assertGreater(self.value(server, "weft_encoded_records_total", scene="hung"), 0)
            self.assertEqual(self.value(server, "weft_step_seconds_count", scene="still"), 0)
        self.until(server, lambda value: value == 0, "weft_viewers")
        for level in "46":
            self.until(server, lambda value: value == 0, "weft_scene_viewers", scene="hung", level=level)
        self.until(server, lambda value: value == 0, "weft_clock_ratio", scene="hung")
        server.get("/none")
        self.assertEqual(self.value(server, "weft_refused_requests_total", status="404"), 1)

    async def test_counts_overruns_of_a_scene_too_heavy(self):
        server = self.start("--set", '/cloths/0/levels={"min":7,"max":7}', "--set", '/integrator={"type":"xpbd","substeps":500}')
        async with await weft.connect(server.url(), timeout=GENEROUS):
            self.until(server, lambda value: value > 0, "weft_step_overruns_total", scene="hung")
        self.assertLessEqual(self.value(server, "weft_step_overruns_total", scene="hung"),
                             self.value(server, "weft_step_seconds_count", scene="hung"))

    def test_tells_of_the_process(self):
        server = self.start()
        self.assertAlmostEqual(self.value(server, "process_resident_memory_bytes"), 1024 * server.memory_kib(), delta=8e6)
        descriptors = pathlib.Path(f"/proc/{server.process.pid}/fd")
        # Two more while it answers: this connection, and the folder that it counts them in. One before may be open still.
        self.until(server, lambda value: value == len(list(descriptors.iterdir())) + 2, "process_open_fds")
        first = self.value(server, "process_cpu_seconds_total")
        self.until(server, lambda value: value > first, "process_cpu_seconds_total")

    def test_every_metric_is_in_the_documents(self):
        server = self.start()
        documented = (ROOT / "server" / "docs" / "operations.md").read_text()
        for name in re.findall(r"^# TYPE (\S+)", server.get("/metrics")[2].decode(), re.MULTILINE):
            self.assertIn(f"`{name}`", documented)

    async def test_the_dashboard_asks_for_nothing_else(self):
        server = self.start()
        async with await weft.connect(server.url(), timeout=GENEROUS) as client:
            with self.assertRaises(weft.WeftError):
                await client.remove_ball(77)
        server.get("/none")
        known = {name for name, _ in samples(server.get("/metrics")[2].decode())} | {"weft_closed_viewers_total"}  # of a flood alone
        dashboard = json.loads((ROOT / "server" / "deploy" / "grafana.json").read_text())
        for panel in dashboard["panels"]:
            for target in panel["targets"]:
                for name in re.findall(r"(?:weft|process)_[a-z_]+", target["expr"]):
                    self.assertIn(name, known, panel["title"])

    def test_only_for_who_runs_the_server(self):
        tokens = {"view": "a-token-of-a-viewer-1", "control": "a-token-of-a-hand-001", "admin": "a-token-of-an-admin-1"}
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "tokens.json"
            file.write_text(json.dumps({"tokens": [{"role": role, "token": token} for role, token in tokens.items()]}))
            server = self.start("--tokens", file)
            self.assertEqual(server.get("/metrics")[0], 401)
            for role, status in [("view", 403), ("control", 403), ("admin", 200)]:
                self.assertEqual(server.get("/metrics", Authorization=f"Bearer {tokens[role]}")[0], status, role)

    def test_is_ready_as_long_as_there_is_a_place(self):
        server = self.start("--connections", 2, "--connections-per-address", 0)
        self.assertEqual(server.get("/readyz")[::2], (200, b"ok"))
        for _ in range(2):
            connection, status = server.raw_socket()
            self.addCleanup(connection.close)
            self.assertEqual(status, 101)
        status, headers, body = server.get("/readyz")
        self.assertEqual((status, body), (503, b"all connections are taken\n"))
        self.assertGreater(int(headers["retry-after"]), 0)
        self.assertEqual(server.get("/healthz")[0], 200)


if __name__ == "__main__":
    unittest.main()
