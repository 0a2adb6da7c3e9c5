"""A Python script against a running server: it moves its camera through the thresholds, throws a ball, sets the wind, and
receives frames at the right levels."""
import unittest

from serving import GENEROUS, SCENES, Server

import weft


class PythonScript(unittest.IsolatedAsyncioTestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(SCENES / "hung.json", SCENES / "still.json")
        cls.addClassCleanup(cls.server.end)

    async def connect(self, scene="hung"):
        """A client and the list of what it is told beside frames and replies."""
        told = []
        client = await weft.connect(self.server.url(scene), on_message=told.append, timeout=GENEROUS)
        self.addAsyncCleanup(client.close)
        return client, told

    async def told(self, client, told, **members):
        """The newest message with these members, waiting for it."""
        def search():
            return next((message for message in reversed(told) if members.items() <= message.items()), None)
        await client.next_frame(lambda frame: search() is not None)
        return search()

    async def test_camera_through_the_thresholds(self):
        scene, _ = await self.connect()
        # Table 1: l_close = 1 m, l_far = 10 m; Eq. 7 counts a threshold itself to the nearer band.
        for distance, level in [(0.8, 6), (5, 5), (12, 4), (10, 5), (10.001, 4), (1, 6), (1.001, 5), (0, 6)]:
            with self.subTest(distance=distance):
                ok = await scene.camera(distance=distance)
                frame = await scene.next_frame(lambda frame: frame.stamp.f >= ok["f"])
                for _ in range(3):
                    cloth = frame.cloths[0]
                    self.assertEqual((cloth.level, cloth.rows, cloth.cols), (level, 2**level + 1, 2**level + 1))
                    frame = await scene.next_frame()

    async def test_camera_by_eye(self):
        scene, _ = await self.connect()
        for eye, level in [([0, 0, 40], 4), ([3, 0, 4], 5)]:  # the cloth hangs within 3 m of the origin
            ok = await scene.camera(eye=eye)
            frame = await scene.next_frame(lambda frame: frame.stamp.f >= ok["f"])
            self.assertEqual(frame.cloths[0].level, level)

    async def test_viewers_at_three_distances(self):
        scenes = [(await self.connect())[0] for _ in range(3)]
        for scene, distance in zip(scenes, [0.8, 5, 12]):
            await scene.camera(distance=distance)
        last = await scenes[0].camera(distance=0.8)
        for scene, level in zip(scenes, [6, 5, 4]):
            frame = await scene.next_frame(lambda frame: frame.stamp.f >= last["f"])
            self.assertEqual((frame.cloths[0].level, frame.cloths[0].simulated_level), (level, 6))

    async def test_thrown_ball_is_seen_by_all(self):
        thrower, _ = await self.connect()
        watcher, told = await self.connect()
        ball = await thrower.add_ball([0, 0.5, 2], radius=0.2)
        event = await self.told(watcher, told, op="event", kind="ball.add", ball=ball)
        self.assertIn({"ball": ball, "position": [0, 0.5, 2], "radius": 0.2, "motion": "kinematic", "friction": 0}, event["balls"])
        ok = await thrower.throw_ball(ball, [0, 1, -6])
        await self.told(watcher, told, op="event", kind="ball.throw", ball=ball)

        def seen(frame):
            return next((seen for seen in frame.balls if seen.ball == ball), None)
        before = await watcher.next_frame(lambda frame: frame.stamp.f >= ok["f"] and seen(frame))
        after = await watcher.next_frame(lambda frame: frame.stamp.f >= before.stamp.f + 6)
        self.assertEqual(seen(after).motion, "dynamic")
        seconds = after.stamp.time - before.stamp.time
        # Towards -z at 6 m/s until it meets the cloth, which hangs more than 1 m away.
        self.assertAlmostEqual(seen(before).position[2] - seen(after).position[2], 6 * seconds, delta=0.01)
        await thrower.remove_ball(ball)
        await self.told(watcher, told, op="event", kind="ball.remove", ball=ball)

    async def test_wind_turns_the_cloth(self):
        scene, told = await self.connect()
        ok = await scene.set_wind([2, 0, 0], 30)
        event = await self.told(scene, told, op="event", kind="wind")
        self.assertEqual(event["wind"], {"direction": [1, 0, 0], "speed": 30})
        self.assertEqual(event["f"], ok["f"])

        def lower_edge_x(frame):
            cloth = frame.cloths[0]
            return cloth.at(cloth.rows - 1, cloth.cols // 2)[0]
        before = await scene.next_frame(lambda frame: frame.stamp.f <= ok["f"] + 3)
        after = await scene.next_frame(lambda frame: frame.stamp.f >= ok["f"] + 30)
        # 30 N/m2 on 0.1 kg/m2 would carry it metres in half a second; the pins hold it back.
        self.assertGreater(lower_edge_x(after), lower_edge_x(before) + 0.3)

    async def test_stats_twice_a_second(self):
        scene, told = await self.connect()
        await scene.camera(distance=12)
        stats = await self.told(scene, told, op="stats")
        while stats["cloths"][0]["distance"] != 12:
            told.clear()
            stats = await self.told(scene, told, op="stats")
        self.assertEqual((stats["cloths"][0]["level"], stats["cloths"][0]["nodes"]), (4, 17 * 17))
        self.assertGreater(stats["step_ms"], 0)

    async def test_pause_step_resume_reset(self):
        scene, told = await self.connect("still")
        paused = (await scene.pause())["f"]
        frame = await scene.next_frame(lambda frame: frame.stamp.paused)
        self.assertEqual(frame.stamp.f, paused)
        self.assertEqual((await scene.step(4))["f"], paused + 4)
        frame = await scene.next_frame(lambda frame: frame.stamp.f == paused + 4)
        self.assertTrue(frame.stamp.paused)
        with self.assertRaises(weft.WeftError) as refused:
            await scene.send("step", count=0)
        self.assertEqual((refused.exception.code, refused.exception.path), ("range", "/count"))
        self.assertEqual((await scene.reset())["f"], 0)
        frame = await scene.next_frame(lambda frame: frame.stamp.epoch == 2)
        self.assertEqual((frame.stamp.f, frame.stamp.time), (0, 0.0))
        await scene.resume()
        await scene.next_frame(lambda frame: frame.stamp.f >= 5 and not frame.stamp.paused)

    async def test_several_scenes(self):
        scene, _ = await self.connect("hung")
        self.assertEqual([each["name"] for each in await scene.list_scenes()], ["hung", "still"])
        await scene.join_scene("still")
        await scene.next_frame(lambda frame: frame.cloths[0].rows == 17)
        while scene.scene["name"] != "still":
            await scene.next_frame()
        self.assertEqual(scene.scene["title"], "A small cloth without wind")


if __name__ == "__main__":
    unittest.main()
