"""A hundred kills in a row, at any moment of a server's life: what was kept is whole each time, and goes on."""
import asyncio
import os
import pathlib
import random
import signal
import subprocess
import tempfile
import time
import unittest

from serving import BINARY, GENEROUS, SCENES, Server

import weft

KILLS = 100
SEED = int(os.environ.get("WEFT_SEED", time.time()))


class Kills(unittest.IsolatedAsyncioTestCase):
    async def test_a_hundred_in_a_row(self):
        chance = random.Random(SEED)
        asyncio.get_running_loop().slow_callback_duration = GENEROUS  # this one waits for processes
        with tempfile.TemporaryDirectory() as folder:
            self.folder = pathlib.Path(folder)
            self.options = SCENES / "hung.json", "--data", self.folder / "data", "--record", self.folder / "recorded"
            self.last = (0, 0)  # epoch and step that were seen last
            self.balls = {}     # that were there when the server was killed, each with when it was answered
            for kill in range(KILLS):
                with self.subTest(f"kill {kill} of seed {SEED}"):
                    if chance.random() < 0.2:
                        self.kill_as_it_starts(chance.uniform(0, 0.3))
                    else:
                        await self.live_and_kill(chance)
            self.assertEqual(list((self.folder / "data" / "hung").glob("*.aside")), [])
            # Without those of which hardly the beginning was written.
            recorded = sorted(file for file in (self.folder / "recorded").glob("*.weftrec") if file.stat().st_size > 4096)
            self.assertGreater(len(recorded), KILLS / 4)
            for file in chance.sample(recorded, 10):
                told = subprocess.run([BINARY, "replay", file, "--validate"], capture_output=True, text=True, timeout=300)
                # It may be cut short, where it was killed; what is there leads to the states that it tells.
                self.assertIn("hashes, all as recorded", told.stdout, told.stderr)

    def kill_as_it_starts(self, after):
        command = [BINARY, "serve", "--port", "0", *map(str, self.options)]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(after)
        process.kill()
        process.wait()

    async def live_and_kill(self, chance):
        with Server(*self.options) as server:
            async with await weft.connect(server.url(), timeout=GENEROUS) as client:
                await client.camera(distance=20)
                first = await client.next_frame()
                self.assertGreater(first.stamp.epoch, self.last[0])  # no epoch comes twice
                self.assertGreaterEqual(first.stamp.f, self.last[1])  # nothing that was seen is lost
                there = {ball.ball for ball in first.balls}
                # What is answered is written within 0.1 s; on a busy machine within a second.
                self.assertLessEqual({ball for ball, age in self.balls.items() if age > 1}, there)
                born = {ball: float("-inf") for ball in there}
                until = time.monotonic() + chance.choice([0, 0.05, chance.uniform(0, 2.5)])
                while time.monotonic() < until:
                    await self.command(client, chance, born)
                frame = await client.next_frame()
                server.terminate(signal.SIGKILL)
                killed = time.monotonic()
                server.process.wait()
                self.last = (frame.stamp.epoch, frame.stamp.f)
                self.balls = {ball: killed - at for ball, at in born.items()}
            self.assertFalse([line for line in server.log_lines if " error " in line], server.log_lines)

    async def command(self, client, chance, born):
        """One of those that change what is kept."""
        what = chance.randrange(4)
        if what == 0 and len(born) < 8:
            born[await client.add_ball([chance.uniform(-1, 1), chance.uniform(-1, 1), 2], 0.1)] = time.monotonic()
        elif what == 1 and born:
            ball = chance.choice(list(born))
            del born[ball]  # killed before that is written, it is there again
            await client.remove_ball(ball)
        elif what == 2:
            await client.set_wind([chance.uniform(-1, 1), 0, 1], chance.uniform(0, 8))
        else:
            await client.set_effect("damping", chance.random() < 0.5)
        await asyncio.sleep(chance.uniform(0, 0.2))


if __name__ == "__main__":
    unittest.main()
