"""How many may connect, from where, and what the health check tells meanwhile."""
import contextlib
import json
import pathlib
import socket
import tempfile
import time
import unittest

from serving import GENEROUS, SCENES, Server

HEALTH = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"


class Limits(unittest.TestCase):
    def start(self, *arguments):
        server = Server(*arguments)
        self.addCleanup(server.end)
        return server

    def viewers(self, server, count):
        """So many WebSockets, kept open."""
        for _ in range(count):
            connection, status = server.raw_socket()
            self.addCleanup(connection.close)
            self.assertEqual(status, 101)

    def idle(self, server):
        """A connection that asks for nothing."""
        connection = socket.create_connection(("127.0.0.1", server.port), GENEROUS)
        self.addCleanup(connection.close)
        return connection

    def until(self, condition):
        end = time.monotonic() + GENEROUS
        while not condition():
            self.assertLess(time.monotonic(), end, "never true")
            time.sleep(0.02)

    def test_one_address_has_so_many_connections(self):
        server = self.start(SCENES / "hung.json", "--connections-per-address", 3)
        self.viewers(server, 3)
        status, headers, body = server.get("/v1/scenes")
        self.assertEqual(status, 429)
        self.assertGreater(int(headers["retry-after"]), 0)
        self.assertIn(b"--connections-per-address", body)
        self.assertEqual(server.upgrade("/v1/scenes/hung"), 429)
        self.assertEqual(server.get("/healthz")[::2], (200, b"ok"))

    def test_a_place_is_free_again_when_its_connection_ends(self):
        server = self.start(SCENES / "hung.json", "--connections-per-address", 1)
        with server.raw_socket()[0]:
            self.assertEqual(server.upgrade("/v1/scenes/hung"), 429)
        self.until(lambda: server.upgrade("/v1/scenes/hung") == 101)

    def test_by_default_no_address_takes_all_seats_of_a_scene(self):
        server = self.start(SCENES / "hung.json")
        self.viewers(server, 128)
        self.assertEqual(server.upgrade("/v1/scenes/hung"), 429)

    def test_health_is_told_when_all_connections_are_taken(self):
        server = self.start(SCENES / "hung.json", "--connections", 4, "--connections-per-address", 0)
        self.viewers(server, 4)
        status, headers, body = server.get("/")
        self.assertEqual(status, 503)
        self.assertGreater(int(headers["retry-after"]), 0)
        self.assertIn(b"--connections", body)
        self.assertEqual(server.get("/healthz")[::2], (200, b"ok"))
        # Not even those that only connect keep it from being told: the oldest of them are ended.
        first = self.idle(server)
        for _ in range(100):
            self.idle(server)
        self.assertEqual(server.get("/healthz")[::2], (200, b"ok"))
        with contextlib.suppress(ConnectionResetError):
            self.assertEqual(first.recv(1), b"")

    def test_a_connection_beyond_the_limits_has_one_answer(self):
        server = self.start(SCENES / "hung.json", "--connections", 1)
        self.viewers(server, 1)
        received = server.request(HEALTH * 3)
        self.assertEqual(received.count(b"HTTP/1.1 200 OK"), 1)

    def test_a_scene_that_does_not_step_is_told(self):
        # A step of this takes many times the 5 s after which it is told, on any machine: 1e10 nodes are stepped.
        scene = json.loads((SCENES / "hung.json").read_text())
        cloth = scene["cloths"][0] | {"levels": {"min": 8, "max": 8}}
        scene["cloths"] = [cloth | {"name": f"cloth-{i}"} for i in range(16)]
        scene["integrator"] = {"type": "xpbd", "substeps": 10000}
        with tempfile.TemporaryDirectory() as folder:
            heavy = pathlib.Path(folder) / "heavy.json"
            heavy.write_text(json.dumps(scene))
            server = self.start(SCENES / "still.json", heavy)
        self.assertEqual(server.get("/healthz")[::2], (200, b"ok"))
        connection, _ = server.raw_socket("/v1/scenes/heavy")
        with connection:
            self.until(lambda: server.get("/healthz")[0] == 503)
            self.assertRegex(server.get("/healthz")[2], rb"^scene heavy: no step for \d+\.\d s\n$")

    def test_limits_that_make_no_sense_are_refused(self):
        for option, value in [("--connections", 0), ("--connections", -1), ("--connections-per-address", -1)]:
            with self.subTest(option):
                with self.assertRaises(AssertionError):
                    Server(SCENES / "hung.json", option, value)


if __name__ == "__main__":
    unittest.main()
