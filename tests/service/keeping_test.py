"""What the server keeps (--data) and records (--record): after any end it goes on where it was, and what it wrote is told true."""
import asyncio
import http.client
import json
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

from serving import BINARY, GENEROUS, SANITIZED, SCENES, Server

import weft

SCENE = SCENES / "hung.json"


def replay(file, *arguments):
    return subprocess.run([BINARY, "replay", str(file), *arguments], capture_output=True, text=True, timeout=300)


class Keeping(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.data = self.folder / "data"

    def start(self, *arguments, scene=SCENE):
        server = Server(scene, *arguments)
        self.addCleanup(server.end)
        return server

    async def join(self, server, scene="hung"):
        client = await weft.connect(server.url(scene), timeout=GENEROUS)
        self.addAsyncCleanup(client.close)
        await client.camera(distance=20)
        return client

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

    def test_a_scene_file_is_named_alone(self):
        told = subprocess.run([pathlib.Path(BINARY).resolve(), "check", SCENE.name], cwd=SCENES, capture_output=True, text=True, timeout=GENEROUS)
        self.assertEqual(told.returncode, 0, told.stderr)

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

    async def test_a_client_is_back_within_2_s_with_what_it_held(self):
        server = self.start("--data", self.data)
        port = server.port
        client = await weft.connect(server.url(), timeout=GENEROUS, reconnect=True)
        self.addAsyncCleanup(client.close)
        await client.camera(distance=20)
        grabs = [await client.grab(0, 0.5, share) for share in (0.3, 0.6)]
        instance, seat = client.welcome["instance"], client.scene["seat"]
        frame = await client.next_frame(lambda frame: frame.stamp.f > 20)
        server.terminate(signal.SIGKILL)
        server.process.wait()
        await asyncio.sleep(0.6)  # attempts fail
        killed = asyncio.get_running_loop().time()
        after = Server(SCENE, "--data", self.data, port=port)
        self.addCleanup(after.end)
        back = await client.next_frame(lambda later: later.stamp.epoch > frame.stamp.epoch)
        if not SANITIZED:
            self.assertLess(asyncio.get_running_loop().time() - killed, 2)
        self.assertGreaterEqual(back.stamp.f, frame.stamp.f)
        for _ in range(100):  # its frames may come before it has resumed
            try:
                await client.move_grab(grabs[0], [0, 0.2, 0.3])
                break
            except weft.WeftError as error:
                self.assertEqual(error.code, "not_found")
                await asyncio.sleep(0.02)
        await client.release(grabs[1])
        self.assertNotEqual(client.welcome["instance"], instance)
        self.assertNotEqual(client.scene["seat"], seat)

    async def test_hands_of_whom_nobody_hears_any_more_let_go_after_5_s(self):
        server = self.start()
        watcher = await self.join(server)
        holder = await self.join(server)
        grab = await holder.grab(0, 0.5, 0.5)
        seat = holder.scene["seat"]
        holder._socket.transport.abort()
        await self.alone(watcher)
        heir = await self.join(server)
        self.assertEqual((await heir.resume_seat(seat))["grabs"], [grab])
        await heir.move_grab(grab, [0, 0, 1])
        with self.assertRaisesRegex(weft.WeftError, "nobody is waited for"):
            await heir.resume_seat(seat)
        seat = heir.scene["seat"]
        heir._socket.transport.abort()
        await asyncio.sleep(5.5)
        with self.assertRaisesRegex(weft.WeftError, "too late"):
            await watcher.resume_seat(seat)
        leaver = await self.join(server)
        await leaver.grab(0, 0.5, 0.5)
        seat = leaver.scene["seat"]
        await leaver.close()  # in order: it does not come back
        await self.alone(watcher)
        with self.assertRaises(weft.WeftError):
            await watcher.resume_seat(seat)

    async def alone(self, client):
        """Waits until the scene knows that all others have left."""
        for _ in range(100):
            if await self.viewers(client) == 1:
                return
        self.fail("there are other viewers still")

    async def viewers(self, client):
        before = client.stats
        while client.stats is before:
            await client.next_frame()
        return client.stats["viewers"]

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
