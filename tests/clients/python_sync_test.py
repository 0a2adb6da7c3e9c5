"""The Python client without asyncio (`weft.open`), against a real server."""
import asyncio
import pathlib
import sys
import threading
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "service"))
from serving import GENEROUS, Server  # noqa: E402

import numpy as np  # noqa: E402
import weft  # noqa: E402


def threads():
    return [thread for thread in threading.enumerate() if thread.name == "weft"]


class Sync(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server("flag")
        cls.addClassCleanup(cls.server.end)
        cls.url = cls.server.url("flag")

    def tearDown(self):
        self.assertEqual(threads(), [])

    def test_frames_are_iterated_over(self):
        steps = []
        with weft.open(self.url, timeout=GENEROUS) as scene:
            self.assertEqual(scene.scene["name"], "flag")
            self.assertEqual(scene.welcome["op"], "welcome")
            for frame in scene:
                steps.append((frame.stamp.epoch, frame.stamp.f))
                positions = frame.cloths[0].positions
                self.assertEqual((positions.dtype, positions.shape), (np.float32, (frame.cloths[0].rows, frame.cloths[0].cols, 3)))
                if len(steps) == 10:
                    break
        self.assertEqual(steps, sorted(set(steps)))

    def test_each_call_waits_for_its_answer(self):
        with weft.open(self.url, timeout=GENEROUS) as scene:
            ball = scene.add_ball(np.array([0.8, 0, 1]), 0.1)
            told = scene.move_ball(ball, [0.8, 0, 2])
            frame = scene.next_frame(lambda frame: frame.stamp.f >= told["f"])
            place, = (each.position for each in frame.balls if each.ball == ball)
            self.assertEqual(place, (np.float32(0.8), 0, 2))
            scene.remove_ball(ball)
            self.assertGreater(scene.ping(), 0)
            self.assertLess(abs(scene.age(frame)), 1000 * GENEROUS)
            self.assertEqual([each["name"] for each in scene.list_scenes()], ["flag"])

    def test_a_refusal_is_raised_and_the_connection_goes_on(self):
        with weft.open(self.url, timeout=GENEROUS) as scene:
            with self.assertRaises(weft.WeftError) as caught:
                scene.set_wind([1, 0, 0], 1000)
            self.assertEqual((caught.exception.code, caught.exception.path), ("range", "/speed"))
            scene.ping()

    def test_a_frame_that_does_not_come(self):
        with weft.open(self.url, timeout=GENEROUS) as scene:
            with self.assertRaises(weft.WeftError) as caught:
                scene.next_frame(lambda frame: False, timeout=0.05)
            self.assertEqual(caught.exception.code, "timeout")
            scene.next_frame()

    def test_messages_are_heard(self):
        heard = []
        with weft.open(self.url, timeout=GENEROUS, on_message=lambda message: heard.append(message["op"])) as scene:
            scene.ping()
        self.assertEqual(heard[:2], ["welcome", "scene"])

    def test_inside_a_loop_that_runs(self):
        async def cell():  # as notebooks run theirs
            with weft.open(self.url, timeout=GENEROUS) as scene:
                return scene.next_frame()
        self.assertEqual(len(asyncio.run(cell()).cloths), 1)

    def test_after_it_is_closed(self):
        with weft.open(self.url, timeout=GENEROUS) as scene:
            scene.next_frame()
        scene.close()  # once more does nothing
        for ask in (scene.pause, scene.next_frame, lambda: next(scene)):
            with self.assertRaises(weft.WeftError) as caught:
                ask()
            self.assertEqual(caught.exception.code, "closed")

    def test_no_such_scene(self):
        with self.assertRaises(weft.WeftError) as caught:
            weft.open(self.server.url("nowhere"), timeout=GENEROUS)
        self.assertEqual(caught.exception.code, "connect")
        self.assertIn("404", str(caught.exception))


class Ending(unittest.TestCase):
    def test_iteration_ends_with_the_server(self):
        server = Server("flag")
        self.addCleanup(server.end)
        with weft.open(server.url("flag"), timeout=GENEROUS) as scene:
            next(scene)
            server.terminate()
            for _ in scene:
                pass
        self.assertEqual(threads(), [])

    def test_a_restart_is_survived(self):
        server = Server("flag")
        self.addCleanup(server.end)
        with weft.open(server.url("flag"), timeout=GENEROUS, reconnect=True) as scene:
            scene.camera(distance=12)
            instance = scene.welcome["instance"]
            server.end()
            again = Server("flag", port=server.port)
            self.addCleanup(again.end)
            deadline = time.monotonic() + GENEROUS
            while scene.welcome.get("instance", instance) == instance and time.monotonic() < deadline:
                scene.next_frame(timeout=GENEROUS)
            self.assertNotEqual(scene.welcome["instance"], instance)
            scene.next_frame(lambda frame: frame.cloths[0].level == 4)  # the camera was told again: flag.json, beyond 8 m


if __name__ == "__main__":
    unittest.main()
