"""What the server keeps (--data): after any end it goes on where it was, and files that are damaged are told."""
import asyncio
import http.client
import json
import shutil
import signal
import subprocess
import unittest

from kept import SCENE, Kept, replay
from serving import BINARY, GENEROUS, SANITIZED, Server

import weft


class Keeping(Kept):
    def files(self):
        return sorted((self.data / "hung").glob("*.weftrec"))

    async def test_goes_on_after_a_kill_with_what_was_there(self):
        server = self.start("--data", self.data)
        client = await self.join(server)
        ball = await client.add_ball([0, 0, 1], 0.2)
        await client.set_wind([1, 0, 0], 2.5)
        await client.tune_effect("paper_wind", factor=0.5)
        frame = await client.next_frame(lambda frame: frame.stamp.f > 80)
        server.terminate(signal.SIGKILL)
        server.process.wait()

        after = self.start("--data", self.data)
        again = await self.join(after)
        first = await again.next_frame()
        self.assertGreaterEqual(first.stamp.f, frame.stamp.f)  # nothing that was seen is lost
        self.assertEqual(first.stamp.epoch, frame.stamp.epoch + 1)
        self.assertEqual([each.ball for each in first.balls], [ball])
        self.assertEqual(again.scene["wind"]["speed"], 2.5)
        self.assertEqual(again.scene["parameters"]["paper_wind"]["factor"], 0.5)
        self.assertIn(f"epoch {frame.stamp.epoch + 1}, from", after.wait_for_log("goes on at"))

    async def test_a_pause_and_what_was_switched_off_last(self):
        server = self.start("--data", self.data)
        client = await self.join(server)
        await client.next_frame(lambda frame: frame.stamp.f > 5)
        await client.set_effect("damping", False)
        await client.pause()
        server.terminate()
        server.process.wait()
        again = await self.join(self.start("--data", self.data))
        self.assertTrue(again.scene["paused"])
        self.assertEqual(again.scene["effects_off"], ["damping"])

    async def test_what_is_commanded_in_a_pause_is_kept_and_done(self):
        options = ("--data", self.data, "--record", self.folder)
        server = self.start(*options)
        client = await self.join(server)
        await client.pause()
        await client.reset()
        await client.set_effect("gravity", False)
        await client.set_effect("paper_wind", False)
        await client.tune_cloth(0, structural=111)
        await asyncio.sleep(0.2)  # a reply goes out before what it answers is written
        server.terminate(signal.SIGKILL)
        server.process.wait()
        after = self.start(*options)
        again = await self.join(after)
        self.assertEqual(again.scene["cloths"][0]["material"]["structural"], 111)
        frame = await again.next_frame()
        await again.step(90)
        later = await again.next_frame(lambda each: each.stamp.f >= frame.stamp.f + 90)
        # Flat, without gravity or wind, it stays where it is.
        lowest = [each.cloths[0].at(each.cloths[0].rows - 1, 0) for each in (frame, later)]  # at levels of their own
        for now, then in zip(*lowest):
            self.assertAlmostEqual(now, then, delta=0.002)
        after.terminate()
        after.process.wait()
        told = replay(self.folder / "hung.2.weftrec", "--validate")
        self.assertEqual(told.returncode, 0, told.stdout)

    async def test_many_kills_leave_no_corrupt_state(self):
        last = (0, 0)
        for kill in range(3 if SANITIZED else 12):
            server = Server(SCENE, "--data", self.data)
            async with await weft.connect(server.url("hung"), timeout=GENEROUS) as client:
                await client.camera(distance=20)
                first = await client.next_frame()
                self.assertGreater(first.stamp.epoch, last[0])
                self.assertGreaterEqual(first.stamp.f, last[1])
                # The first ones as soon as there is something to see: even then no epoch comes twice.
                frame = first
                if kill >= 2:
                    await asyncio.sleep(0.13 * kill)
                    frame = await client.next_frame()
                last = (frame.stamp.epoch, frame.stamp.f)
                server.terminate(signal.SIGKILL)
                server.process.wait()
            self.assertFalse([line for line in server.log_lines if " error " in line], server.log_lines)
            server.end()
        self.assertEqual(list((self.data / "hung").glob("*.aside")), [])

    async def test_damaged_files_are_read_up_to_there_or_set_aside(self):
        server = self.start("--data", self.data)
        client = await self.join(server)
        await client.next_frame(lambda frame: frame.stamp.f > 130)
        server.terminate(signal.SIGKILL)
        server.process.wait()
        files = self.files()
        self.assertGreater(len(files), 1)
        whole = files[-1].read_bytes()
        files[-1].write_bytes(whole[:len(whole) // 2])  # in its state
        after = self.start("--data", self.data)
        again = await self.join(after)
        self.assertGreater((await again.next_frame()).stamp.f, 30)
        self.assertIn("is cut short at byte", after.wait_for_log("is set aside"))
        self.assertIn(files[-2].name, after.wait_for_log("goes on at"))
        after.terminate()
        after.process.wait()
        for file in self.files():
            file.write_bytes(b"weftrec\x01" + bytes(100))
        last = self.start("--data", self.data)
        third = await self.join(last)
        self.assertLess((await third.next_frame()).stamp.f, 30)  # from the beginning
        self.assertEqual(len(list((self.data / "hung").glob("*.aside"))), 1 + 3)

    async def test_of_another_scene_by_that_name_is_set_aside(self):
        server = self.start("--data", self.data)
        client = await self.join(server)
        await client.next_frame(lambda frame: frame.stamp.f > 10)
        server.terminate()
        server.process.wait()
        other = self.start("--data", self.data, "--set", "/cloths/0/size=[1,1]")
        await self.join(other)
        self.assertIn("another scene by that name", other.wait_for_log("is set aside"))

    async def test_a_folder_that_cannot_be_written_stops_no_scene(self):
        server = self.start("--data", self.data)
        client = await self.join(server)
        await client.next_frame(lambda frame: frame.stamp.f > 5)
        shutil.rmtree(self.data / "hung")
        (self.data / "hung").write_text("in the way")
        server.wait_for_log("it runs on without")
        frame = await client.next_frame()
        await client.next_frame(lambda later: later.stamp.f > frame.stamp.f + 5)
        self.assertIn(b'weft_log_failures_total{scene="hung"} 1', server.get("/metrics")[2])
        (self.data / "hung").unlink()
        server.wait_for_log("data is written again")
        self.assertTrue(self.files())

    def test_a_folder_is_one_servers(self):
        self.start("--data", self.data)
        second = subprocess.run([BINARY, "serve", "--port", "0", str(SCENE), "--data", str(self.data)],
                                capture_output=True, text=True, timeout=GENEROUS)
        self.assertEqual(second.returncode, 1)
        self.assertEqual(second.stderr, f"weft: data {self.data}: another server has it\n")
        self.data.joinpath("file").write_text("")
        third = subprocess.run([BINARY, "serve", "--port", "0", str(SCENE), "--data", str(self.data / "file")],
                               capture_output=True, text=True, timeout=GENEROUS)
        self.assertEqual((third.returncode, third.stdout), (1, ""))
        self.assertEqual(len(third.stderr.splitlines()), 1)

    async def test_scenes_that_clients_made_are_there_again_and_gone_when_ended(self):
        def ask(server, method, name, body=None):
            connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=GENEROUS)
            connection.request(method, f"/v1/scenes/{name}", body)
            status = connection.getresponse().status
            connection.close()
            return status

        server = self.start("--data", self.data)
        document = SCENE.read_text()
        self.assertEqual([ask(server, "PUT", name, document) for name in ("mine", "gone")], [201, 201])
        client = await self.join(server, "mine")
        frame = await client.next_frame(lambda frame: frame.stamp.f > 20)
        self.assertEqual([ask(server, "PUT", "late", document), ask(server, "DELETE", "gone")], [201, 204])
        server.terminate(signal.SIGKILL)
        server.process.wait()
        after = self.start("--data", self.data)
        names = [scene["name"] for scene in json.loads(after.get("/v1/scenes")[2])["scenes"]]
        self.assertEqual(names, ["hung", "late", "mine"])
        self.assertEqual(list(self.data.glob(".*.gone")), [])
        again = await self.join(after, "mine")
        self.assertGreaterEqual((await again.next_frame()).stamp.f, frame.stamp.f)
        self.assertEqual(ask(after, "DELETE", "mine"), 204)


if __name__ == "__main__":
    unittest.main()
