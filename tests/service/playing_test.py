"""weft replay --serve: what was recorded of a scene is shown to viewers, who can watch it and not change it."""
import pathlib
import re
import subprocess
import tempfile
import unittest

from serving import BINARY, GENEROUS, SCENES, Server

import weft

SCENE = SCENES / "hung.json"


class Playing(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def start(self, *arguments, **how):
        server = Server(*arguments, **how)
        self.addCleanup(server.end)
        return server

    async def join(self, server):
        client = await weft.connect(server.url(), timeout=GENEROUS)
        self.addAsyncCleanup(client.close)
        await client.camera(distance=20)
        return client

    async def recorded(self):
        """A recording in which a ball is added and the wind is set, and how many steps it has."""
        server = self.start(SCENE, "--record", self.folder)
        client = await self.join(server)
        await client.next_frame(lambda frame: frame.stamp.f >= 10)
        await client.add_ball([0, 0, 1], 0.2)
        await client.set_wind([1, 0, 0], 2.5)
        await client.next_frame(lambda frame: frame.stamp.f >= 40)
        await client.close()
        server.terminate()  # killed, it would not have written the last quarter of a second
        server.process.wait()
        file = self.folder / "hung.weftrec"
        told = subprocess.run([BINARY, "replay", file], capture_output=True, text=True, timeout=GENEROUS).stdout
        return file, int(re.search(r", (\d+) steps", told)[1])

    async def test_is_shown_to_its_end_and_begun_anew(self):
        file, steps = await self.recorded()
        server = self.start(file, "--serve", command="replay")
        client = await self.join(server)
        first = await client.next_frame()
        self.assertEqual(list(first.balls), [])
        last = await client.next_frame(lambda frame: frame.stamp.f == steps)
        self.assertEqual([ball.ball for ball in last.balls], [1])
        with self.assertRaises(weft.WeftError) as refused:
            await client.set_wind([0, 0, 1], 1)
        self.assertEqual(refused.exception.code, "unavailable")
        self.assertIn("a recording is shown", str(refused.exception))
        self.assertEqual(subprocess.run([BINARY, "client", server.url(), "--health"], capture_output=True, timeout=GENEROUS,
                                        check=False).returncode, 0)
        await client.reset()
        await client.resume()
        again = await client.next_frame(lambda frame: frame.stamp.epoch == first.stamp.epoch + 1)
        self.assertLess(again.stamp.f, steps)

    async def test_begins_at_a_time_and_loops(self):
        file, steps = await self.recorded()
        server = self.start(file, "--serve", "--seek", "0.5", "--loop", command="replay")
        client = await self.join(server)
        first = await client.next_frame()
        self.assertGreaterEqual(first.stamp.f, 30)  # 0.5 s of 60 steps each
        self.assertEqual([ball.ball for ball in first.balls], [1])
        again = await client.next_frame(lambda frame: frame.stamp.epoch > first.stamp.epoch)
        self.assertLess(again.stamp.f, steps)
        self.assertGreaterEqual(again.stamp.f, 30)

    async def test_options_of_serving_need_it(self):
        file, _ = await self.recorded()
        for arguments in (("--port", "0"), ("--loop",), ("--serve", "--validate")):
            done = subprocess.run([BINARY, "replay", file, *arguments], capture_output=True, text=True, timeout=GENEROUS)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn("--serve", done.stderr)

    async def test_there_is_something_to_loop(self):
        file, _ = await self.recorded()
        done = subprocess.run([BINARY, "replay", file, "--serve", "--loop", "--seek", "3600", "--port", "0"],
                              capture_output=True, text=True, timeout=GENEROUS)
        self.assertNotEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"--loop: .* has \d+ steps, and none from --seek on")


if __name__ == "__main__":
    unittest.main()
