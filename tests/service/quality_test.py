"""A scene held to a quality: it is studied beside its steps, a choice is made, viewers are told, and commands change it. Only
facts of structure are checked, none that hangs on the machine's speed."""
import pathlib
import unittest

from serving import GENEROUS, SCENES, Server

import weft

PATIENCE = 240  # s: a study takes some seconds, a sanitizer makes it many


class Quality(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        self.server = Server(SCENES / "kept.json", SCENES / "still.json", SCENES / "hung.json")
        self.addCleanup(self.server.end)

    async def connect(self, scene):
        told = []
        client = await weft.connect(self.server.url(scene), on_message=told.append, timeout=GENEROUS)
        self.addAsyncCleanup(client.close)
        return client, told

    async def told(self, client, told, accept):
        """The first message that is accepted, waiting for it while frames keep coming."""
        def search():
            return next((message for message in told if accept(message)), None)
        await client.next_frame(lambda frame: search() is not None, timeout=PATIENCE)
        return search()

    async def quality(self, client, told, accept):
        """The first `quality` in stats to come that is accepted."""
        told.clear()
        stats = await self.told(client, told, lambda message: message["op"] == "stats" and accept(message.get("quality", {})))
        return stats["quality"]

    def studies(self):
        """Threads that study a scene."""
        tasks = pathlib.Path(f"/proc/{self.server.process.pid}/task").glob("*/comm")
        return sum(task.read_text().strip() == "weft study" for task in tasks)

    def point_of(self, curve, quality):
        """The curve's point that is in use, and the best ones of its level."""
        level = next(level for level in curve["levels"] if level["level"] == quality["level"])
        best = [point for point in level["points"] if point["best"]]
        return next(p for p in best if (p["integrator"], p["setting"]) == (quality["integrator"], quality["setting"])), best

    async def test_a_scene_is_measured_then_kept_to_its_wish_and_to_viewers_commands(self):
        scene, told = await self.connect("kept")
        watcher, seen = await self.connect("kept")
        measuring = await self.told(scene, told, lambda message: message["op"] == "stats")
        self.assertEqual(measuring["quality"], {"wish": {"max_error": 0.002}, "state": "measuring"})
        first = await watcher.next_frame()
        self.assertEqual((await scene.ask_cost())["op"], "ok")
        curve = await self.told(scene, told, lambda message: message["op"] == "curve")
        last = await watcher.next_frame(lambda frame: frame.stamp.f > first.stamp.f)
        self.assertGreater(last.stamp.f, first.stamp.f)
        self.assertFalse(any(message["op"] == "curve" for message in seen), "only who asked is told")
        self.assertEqual([level["level"] for level in curve["levels"]], [3, 4])
        for level in curve["levels"]:
            self.assertEqual(level["points"], sorted(level["points"], key=lambda point: point["ms"]))
            self.assertEqual(sum(point["own"] for point in level["points"]), 1)
        self.assertEqual(curve["levels"][1]["space"], 0)
        self.assertGreater(curve["levels"][0]["space"], 0)

        # The cheapest that is accurate enough.
        quality = await self.quality(scene, told, lambda quality: quality["state"] == "chosen")
        self.assertEqual((quality["wish"], quality["level"]), ({"max_error": 0.002}, 4))
        point, best = self.point_of(curve, quality)
        self.assertEqual((quality["ms_expected"], quality["error_expected"]), (point["ms"], point["error"]))
        enough = [point for point in best if point["error"] <= 0.002]
        self.assertEqual(quality["met"], bool(enough))
        self.assertEqual(point, enough[0] if enough else best[-1])

        # A second is enough for any of them: the most accurate.
        ok = await scene.set_quality(max_ms=1000)
        event = await self.told(watcher, seen, lambda message: message.get("kind") == "quality")
        self.assertEqual((event["wish"], event["f"]), ({"max_ms": 1000}, ok["f"]))
        quality = await self.quality(watcher, seen, lambda quality: quality["wish"] == {"max_ms": 1000})
        self.assertTrue(quality["met"])
        point, best = self.point_of(curve, quality)
        self.assertEqual(point, best[-1])

        # Farther away, another level.
        for each in scene, watcher:
            await each.camera(distance=20)
        quality = await self.quality(scene, told, lambda quality: quality["level"] == 3)
        self.assertEqual(self.point_of(curve, quality)[0], self.point_of(curve, quality)[1][-1])

        await scene.set_quality()
        quality = await self.quality(scene, told, lambda quality: quality["wish"] != {"max_ms": 1000})
        self.assertEqual(quality["wish"], {"max_error": 0.002})

    async def test_bad_values_get_their_error_and_change_nothing(self):
        scene, told = await self.connect("still")
        for members, code, message in [
                ({"max_error": 0}, "range", "/max_error is 0; allowed: 1e-06..1"),
                ({"max_ms": -2}, "range", "/max_ms is -2; allowed: 0.01..1000 (ms)"),
                ({"max_ms": "2"}, "bad_type", '/max_ms is "2"; allowed: a number 0.01..1000 (ms)'),
                ({"max_error": 0.1, "max_ms": 2}, "conflict",
                 "/max_ms is given beside /max_error; allowed: at most one of /max_error and /max_ms")]:
            with self.subTest(members=members), self.assertRaises(weft.WeftError) as refused:
                await scene.send("quality", **members)
            self.assertEqual((refused.exception.code, str(refused.exception)), (code, message))
        told.clear()
        stats = await self.told(scene, told, lambda message: message["op"] == "stats")
        self.assertNotIn("quality", stats)

    async def test_a_study_is_made_only_where_one_is_asked_for_and_ends_with_the_server(self):
        scene, told = await self.connect("still")
        await self.told(scene, told, lambda message: message["op"] == "stats")
        self.assertEqual(self.studies(), 0)
        large, told = await self.connect("hung")  # a study of it takes many seconds, stats come twice in each
        await large.set_quality(max_ms=5)
        await self.quality(large, told, lambda quality: quality.get("state") == "measuring")
        self.assertEqual(self.studies(), 1)
        self.server.terminate()
        self.assertEqual(self.server.process.wait(GENEROUS), 0)


if __name__ == "__main__":
    unittest.main()
