"""How `weft serve` starts and ends."""
import os
import re
import signal
import subprocess
import tempfile
import time
import unittest

from serving import BINARY, GENEROUS, SANITIZED, SCENES, Server

import weft

STOP_TIME = 5  # s: what is promised


class Stopping(unittest.IsolatedAsyncioTestCase):
    def start(self, *arguments, **options):
        server = Server(*arguments, **options)
        self.addCleanup(server.end)
        return server

    async def test_sigterm_tells_viewers_and_ends(self):
        for number in [signal.SIGTERM, signal.SIGINT]:
            with self.subTest(number):
                server = self.start(SCENES / "hung.json")
                told = []
                viewers = [await weft.connect(server.url(), on_message=told.append, timeout=GENEROUS) for _ in range(3)]
                for viewer in viewers:
                    await viewer.next_frame()
                server.terminate(number)
                for viewer in viewers:
                    async for _ in viewer:  # ends in order, by 1001
                        pass
                    self.assertEqual(viewer._socket.close_code, 1001)
                self.assertEqual(sum(message.get("code") == "shutdown" for message in told), 3)
                self.assertEqual(server.process.wait(STOP_TIME), 0)

    def test_sigterm_ends_it_although_a_viewer_does_not_read(self):
        server = self.start(SCENES / "hung.json")
        viewer, _ = server.raw_socket()
        with viewer:
            server.terminate()
            self.assertEqual(server.process.wait(STOP_TIME), 0)

    def test_sigterm_interrupts_a_step_of_minutes(self):
        server = self.start(SCENES / "hung.json", "--set", '/cloths/0/levels={"min":8,"max":8}',
                            "--set", '/integrator={"type":"xpbd","substeps":10000}')
        viewer, _ = server.raw_socket()
        with viewer:
            received = b""
            while b'"op":"scene"' not in received:  # from then on its thread steps
                received += viewer.recv(65536)
            time.sleep(0.2)
            server.terminate()
            self.assertEqual(server.process.wait(STOP_TIME), 0)

    def test_a_second_signal_ends_it_at_once(self):
        server = self.start(SCENES / "hung.json")
        viewer, _ = server.raw_socket()  # that does not answer the good-bye
        with viewer:
            server.terminate()
            server.wait_for_log("stopping")
            server.terminate()
            self.assertEqual(server.process.wait(GENEROUS), 128 + signal.SIGTERM)

    async def test_it_goes_on_when_its_terminal_and_the_reader_of_its_log_go(self):
        # As `weft serve 2>&1 | grep -m 1 Weft` in a terminal that is closed.
        reading, writing = os.pipe()
        process = subprocess.Popen([BINARY, "serve", SCENES / "hung.json", "--port", "0"], stdout=writing, stderr=writing)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        os.close(writing)
        with os.fdopen(reading) as output:
            port = next(match.group(1) for line in output if (match := re.match(r"Weft is at http://127\.0\.0\.1:(\d+)/", line)))
        process.send_signal(signal.SIGHUP)
        # Comings and goings are logged.
        for _ in range(3):
            async with await weft.connect(f"ws://127.0.0.1:{port}/v1/scenes/hung", timeout=GENEROUS) as viewer:
                f = (await viewer.next_frame()).stamp.f
                await viewer.next_frame(lambda frame: frame.stamp.f > f)
        self.assertIsNone(process.poll())
        process.terminate()
        self.assertEqual(process.wait(STOP_TIME), 0)

    async def test_another_can_start_at_the_same_port(self):
        first = self.start(SCENES / "hung.json")
        viewer = await weft.connect(first.url(), timeout=GENEROUS)
        await viewer.next_frame()
        first.terminate()
        self.assertEqual(first.process.wait(STOP_TIME), 0)
        second = self.start(SCENES / "hung.json", port=first.port)
        async with await weft.connect(second.url(), timeout=GENEROUS) as again:
            self.assertLess((await again.next_frame()).stamp.f, 60)  # from the start
        await viewer.close()

    def test_without_viewers_it_ends_too(self):
        server = self.start(SCENES / "hung.json")
        if SANITIZED:
            # ThreadSanitizer loses a signal that comes while a thread is about to block for the first time: a dozen lines
            # with a handler and epoll_wait wait for ever as well. By the time it answers it has blocked.
            self.assertEqual(server.get("/v1/scenes")[0], 200)
        server.terminate()
        self.assertEqual(server.process.wait(STOP_TIME), 0)

    def refusal(self, *arguments):
        """Exit code, output and the lines of complaint of a `weft serve` that cannot start."""
        done = subprocess.run([BINARY, "serve", *map(str, arguments)], capture_output=True, text=True, timeout=GENEROUS)
        return done.returncode, done.stdout, done.stderr.splitlines()

    def test_a_port_in_use_is_one_clear_line(self):
        server = self.start(SCENES / "hung.json")
        self.assertEqual(self.refusal(SCENES / "hung.json", "--port", server.port, "--quiet"),
                         (1, "", [f"weft: cannot listen at 127.0.0.1:{server.port}: Address already in use"]))

    def test_a_bad_scene_is_refused_with_all_its_problems(self):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as scene:
            scene.write('{"title": 5, "cloths": [], "colour": "red"}')
            scene.flush()
            code, output, complaints = self.refusal(scene.name, "--port", 0)
        self.assertEqual((code, output), (1, ""))
        for path in ["/title", "/cloths", "/colour"]:
            self.assertTrue(any(path in line for line in complaints), (path, complaints))

    def test_two_scenes_of_one_name_are_refused(self):
        code, _, complaints = self.refusal(SCENES / "hung.json", SCENES / "hung.json", "--port", 0)
        self.assertEqual((code, complaints), (1, ["weft: there are two scenes named hung"]))

    def test_without_arguments_it_has_all_presets(self):
        server = self.start()
        status, _, body = server.get("/v1/scenes")
        self.assertEqual(status, 200)
        for preset in [b"flag", b"flag-gusts", b"curtain", b"fan", b"tablecloth", b"silk", b"round-table", b"cape", b"walker", b"sail", b"trampoline",
                       b"washing-line", b"towel", b"swing",
                       b"zheng2020-wind", b"zheng2020-distance", b"zheng2020-ball"]:
            self.assertIn(b'"' + preset + b'"', body)


if __name__ == "__main__":
    unittest.main()
