"""What the server records (--record): it is done again to the bit, sought in, and read up to where it is damaged."""
import asyncio
import re
import unittest

from kept import Kept, replay


class Recording(Kept):
    async def test_a_recording_is_done_again_to_the_bit(self):
        server = self.start("--record", self.folder / "recorded")
        client = await self.join(server)
        ball = await client.add_ball([0, 0, 1], 0.2, motion="dynamic", mass=0.5)
        grab = await client.grab(0, 0.5, 0.5)
        await client.next_frame(lambda frame: frame.stamp.f > 60)
        await client.throw_ball(ball, [0, 0, -4])
        await client.move_grab(grab, [0, 0.3, 0.5])
        await client.camera(distance=0.5)  # other levels
        await client.next_frame(lambda frame: frame.stamp.f > 130)
        await client.reset()
        await client.next_frame(lambda frame: frame.stamp.epoch == 2 and frame.stamp.f > 60)
        server.terminate()
        server.process.wait()
        file = self.folder / "recorded" / "hung.weftrec"
        told = replay(file, "--validate")
        self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
        self.assertRegex(told.stdout, r"[3-9] hashes, all as recorded")
        self.assertEqual(replay(file, "--validate", "--threads", "1").stdout, told.stdout)

        # A second run does not write over the first.
        self.start("--record", self.folder / "recorded")
        for _ in range(100):
            if (self.folder / "recorded" / "hung.2.weftrec").exists():
                break
            await asyncio.sleep(0.1)
        whole = file.read_bytes()
        self.assertEqual(replay(file).returncode, 0)
        file.write_bytes(whole[:-20])
        cut = replay(file, "--validate")
        self.assertEqual(cut.returncode, 1)
        self.assertRegex(cut.stdout, r"cut short at byte \d+: read up to there")
        self.assertRegex(cut.stdout, r"hashes, all as recorded")
        place = len(whole) // 2
        file.write_bytes(whole[:place] + bytes([whole[place] ^ 4]) + whole[place + 1:])
        # A changed length makes a chunk longer than what is left of the file.
        self.assertRegex(replay(file).stdout, r"(damaged|cut short) at byte \d+: read up to there")
        file.write_text("no recording")
        none = replay(file)
        self.assertEqual((none.returncode, none.stderr), (1, f"weft: {file}: it is no recording of this format\n"))

    async def test_a_seek_is_to_the_state_that_was(self):
        server = self.start("--record", self.folder)
        client = await self.join(server)
        await client.pause()
        await client.step(600)
        await client.next_frame(lambda frame: frame.stamp.f >= 600)
        await client.step(60)
        await client.next_frame(lambda frame: frame.stamp.f >= 660)
        server.terminate()
        server.process.wait()
        file = self.folder / "hung.weftrec"
        at_end = re.search(r"state (\w+)", replay(file, "--validate").stdout).group(1)
        self.assertEqual(re.search(r"state (\w+)", replay(file, "--seek", "1000").stdout).group(1), at_end)
        self.assertIn("step 620,", replay(file, "--seek", "10.3333").stdout)


if __name__ == "__main__":
    unittest.main()
