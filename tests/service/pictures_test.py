"""What a frame weighs: as much as the viewer's picture can show."""
import math
import re
import unittest

import numpy as np
from serving import GENEROUS, Server

import weft

EYE, TARGET = [0.9, 0, 2.6], [0.9, 0, 0]
HALF_ANGLE = 0.7               # rad: of 1920 x 1080 pixels, 45 degrees high
PIXEL = math.tan(0.7) / (2203 / 2)  # rad, in the picture's middle
FRAMES = 240


class Pictures(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        self.server = Server("flag")
        self.addCleanup(self.server.end)

    def sent(self):
        """Frames and their bytes, so far."""
        text = self.server.get("/metrics")[2]
        return [int(re.search(rb"^weft_sent_%s_total (\d+)" % name, text, re.MULTILINE)[1]) for name in (b"frames", b"frame_bytes")]

    async def bytes_a_node(self, viewer):
        """Of the flag's frames at level 6, the mean of some."""
        await viewer.next_frame(lambda frame: frame.cloths[0].level == 6 and frame.stamp.f >= 60)
        before = self.sent()
        for _ in range(FRAMES):
            frame = await viewer.next_frame()
        frames, sent = (now - then for now, then in zip(self.sent(), before))
        self.assertEqual((frame.cloths[0].rows, frame.cloths[0].cols), (65, 65))
        return sent / frames / 65**2

    async def test_a_flag_at_level_6_takes_two_bytes_a_node(self):
        async with await weft.connect(self.server.url("flag"), timeout=GENEROUS) as viewer:
            await viewer.camera(eye=EYE, target=TARGET, half_angle=HALF_ANGLE)
            self.assertLessEqual(await self.bytes_a_node(viewer), 2.0)  # of 3.27 on the finest lattice

    async def test_compact_it_takes_2_7_on_the_finest_lattice(self):
        async with await weft.connect(self.server.url("flag"), timeout=GENEROUS, compact=True) as viewer:
            await viewer.camera(eye=EYE)
            size = await self.bytes_a_node(viewer)
            print(f"{size:.3f} bytes a node")
            self.assertLessEqual(size, 2.7)

    async def test_what_is_seen_is_the_same(self):
        async with await weft.connect(self.server.url("flag"), timeout=GENEROUS) as viewer, \
                await weft.connect(self.server.url("flag"), timeout=GENEROUS) as exact:
            await viewer.camera(eye=EYE, target=TARGET, half_angle=HALF_ANGLE)
            await exact.camera(eye=EYE)
            await exact.next_frame(lambda frame: frame.stamp.f >= 60)
            stamp = (await exact.pause())["f"]
            shown, real = [(await each.next_frame(lambda frame: frame.stamp.f == stamp)).cloths[0] for each in (viewer, exact)]
            self.assertGreater(shown.quantum, 4 * real.quantum)
            rays = [np.asarray(cloth.positions, float) - EYE for cloth in (shown, real)]
            across = np.linalg.norm(np.cross(*rays), axis=2)
            angles = np.arctan2(across, (rays[0] * rays[1]).sum(axis=2))
            self.assertLessEqual(angles.max(), PIXEL / 4 + real.quantum / np.linalg.norm(rays[1], axis=2).min())


if __name__ == "__main__":
    unittest.main()
