"""`weft serve --split`: each scene once more for each level, held to it."""
import asyncio
import json
import unittest

from serving import Server

import weft


class Split(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server("fan", "curtain", "--split", "5,4")
        cls.addClassCleanup(cls.server.end)

    def test_scenes_are_listed_after_the_one_that_they_hold(self):
        _, _, body = self.server.get("/v1/scenes")
        scenes = json.loads(body)["scenes"]
        # The curtain gives the nodes of its start, those of level 4: it is held to that one alone.
        self.assertEqual([each["name"] for each in scenes], ["fan", "fan-level-5", "fan-level-4", "curtain", "curtain-level-4"])
        self.assertEqual(scenes[1]["title"], scenes[0]["title"] + ", level 5")
        self.server.wait_for_log("curtain cannot be held to level 5 (--split): /cloths/0/nodes: is an array of")

    def test_a_held_scene_has_one_level_whatever_the_distance(self):
        async def levels(distance):
            async with await weft.connect(self.server.url("fan-level-5")) as scene:
                await scene.camera(distance=distance)
                frame = await scene.next_frame()
                cloth = scene.scene["cloths"][0]
                return cloth["min_level"], cloth["max_level"], frame.cloths[0].level, frame.cloths[0].simulated_level

        for distance in (0.1, 100):
            self.assertEqual(asyncio.run(levels(distance)), (5, 5, 5, 5))


if __name__ == "__main__":
    unittest.main()
