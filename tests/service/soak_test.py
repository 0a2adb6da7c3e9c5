"""Hours of use in some minutes: viewers come and go, flood, command and break off, the server is killed in between. Its memory and
descriptors stay what they were, and each of its lives can be made again to the bit. soak_test.py [--minutes M]"""
import asyncio
import contextlib
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from serving import BINARY, GENEROUS, SCENES, Server

import weft
import websockets

MINUTES = 10
LIVES = 3
SEED = int(os.environ.get("WEFT_SEED", time.time()))
VIEWERS, FLOODERS = 6, 2
GROWTH_KIB = 4096  # of a life's second half: what the allocator keeps of peaks, not what leaks in minutes of joins


class Soak(unittest.IsolatedAsyncioTestCase):
    async def test_memory_and_descriptors_stay_and_all_can_be_made_again(self):
        print(f"{MINUTES} minutes, seed {SEED}")
        asyncio.get_running_loop().slow_callback_duration = GENEROUS  # this one waits for processes
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for life in range(LIVES):
                server = Server(SCENES / "hung.json", "--data", folder / "data", "--record", folder / "recorded",
                                "--connections-per-address", 0)
                try:
                    await self.live(server, random.Random(SEED + life), 60 * MINUTES / LIVES)
                finally:
                    server.terminate(signal.SIGKILL if life + 1 < LIVES else signal.SIGTERM)
                    server.process.wait()
                    server.end()
            for file in sorted((folder / "recorded").glob("*.weftrec")):
                told = subprocess.run([BINARY, "replay", file, "--validate"], capture_output=True, text=True, timeout=600 * MINUTES)
                print(told.stdout.splitlines()[-1])
                self.assertRegex(told.stdout, r"[1-9]\d* hashes, all as recorded")

    async def live(self, server, chance, seconds):
        self.url, self.counts = server.url(), {"joined": 0, "commands": 0, "refused": 0, "floods": 0}
        at_rest = []
        for _ in range(2):
            end = time.monotonic() + seconds / 2
            await asyncio.gather(*[self.view(chance, end) for _ in range(VIEWERS)], *[self.flood(end) for _ in range(FLOODERS)],
                                 self.command(chance, end))
            at_rest.append(await self.rest(server))
        print(self.counts, "MiB and descriptors:", [(memory // 1024, files) for memory, files in at_rest])
        (memory, files), (memory_after, files_after) = at_rest
        self.assertLess(memory_after - memory, GROWTH_KIB)
        self.assertLessEqual(files_after, files)
        self.assertFalse([line for line in server.log_lines if " error " in line], server.log_lines)
        for what, count in self.counts.items():
            self.assertGreater(count, 0, what)

    async def rest(self, server):
        """Memory, KiB, and open files when all have left."""
        end = time.monotonic() + GENEROUS
        while (viewers := int(re.search(rb"^weft_viewers (\d+)", server.get("/metrics")[2], re.MULTILINE)[1])) > 0:
            self.assertLess(time.monotonic(), end, f"{viewers} viewers are there")
            await asyncio.sleep(0.1)
        await asyncio.sleep(0.5)
        return server.memory_kib(), len(os.listdir(f"/proc/{server.process.pid}/fd"))

    async def view(self, chance, end):
        """Viewers one after the other, some of whom break off."""
        while time.monotonic() < end:
            client = await weft.connect(self.url, timeout=GENEROUS, coarser=chance.random() < 0.5)
            self.counts["joined"] += 1
            eye = [chance.uniform(-3, 3), chance.uniform(-3, 3), chance.uniform(0.5, 15)]
            await client.camera(eye=eye, target=[0, 0, 0], half_angle=0.7)
            for _ in range(chance.randrange(60)):
                await client.next_frame()
            if chance.random() < 0.3:
                await client.grab(0, chance.random(), chance.random())
                client._socket.transport.abort()
            await client.close()

    async def flood(self, end):
        """Messages until the server has enough, and malformed ones."""
        while time.monotonic() < end:
            async with websockets.connect(self.url, subprotocols=["weft.v1"], compression=None, close_timeout=1) as socket:
                with contextlib.suppress(websockets.ConnectionClosed):
                    for i in range(600):
                        await socket.send(['{"op":"ping","t":1}', '{"op":', '{"op":"camera","distance":-1}'][i % 3])
                        if i % 50 == 0:
                            await asyncio.sleep(0.05)
            self.counts["floods"] += 1
            await asyncio.sleep(1)

    async def command(self, chance, end):
        """Everything that may be commanded, with what may be asked for and what may not."""
        balls, grabs = [], []
        async with await weft.connect(self.url, timeout=GENEROUS) as client:
            def somewhere():
                return [chance.uniform(-2, 2) for _ in range(3)]

            async def add():
                balls.append(await client.add_ball(somewhere(), chance.uniform(0.05, 0.4),
                                                   motion=chance.choice(["kinematic", "dynamic"])))

            async def hold():
                grabs.append(await client.grab(0, chance.random(), chance.random()))

            async def step():
                await client.pause()
                await client.step(chance.randrange(1, 10))
                await client.resume()
            doings = [
                add, hold, step, client.reset,
                lambda: client.remove_ball(balls.pop()), lambda: client.throw_ball(chance.choice(balls), somewhere()),
                lambda: client.move_ball(chance.choice(balls), somewhere()), lambda: client.move_grab(chance.choice(grabs), somewhere()),
                lambda: client.release(grabs.pop()), lambda: client.pin(0, chance.random(), chance.random()),
                lambda: client.unpin(0, chance.random(), chance.random()), lambda: client.set_wind([1, 0, 1], chance.uniform(0, 9)),
                lambda: client.set_effect("damping", chance.random() < 0.5),
                lambda: client.tune_cloth(0, structural=chance.uniform(100, 400)),
            ]
            while time.monotonic() < end:
                try:
                    await chance.choice(doings)()
                    self.counts["commands"] += 1
                except (weft.WeftError, IndexError):
                    self.counts["refused"] += 1
                await asyncio.sleep(chance.uniform(0, 0.1))


if __name__ == "__main__":
    if "--minutes" in sys.argv:
        at = sys.argv.index("--minutes")
        MINUTES = float(sys.argv[at + 1])
        del sys.argv[at:at + 2]
    unittest.main()
