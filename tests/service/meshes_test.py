"""What a scene tells of its meshes, and where their surfaces are."""
import asyncio
import json
import unittest

from serving import SCENES, Server

import weft


class Meshes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(SCENES / "solids.json", SCENES / "still.json", "--allow-origin", "https://show.example")
        cls.addClassCleanup(cls.server.end)

    def test_the_scene_has_their_sizes_and_the_surfaces_are_beside_it(self):
        async def look():
            async with await weft.connect(self.server.url("solids")) as scene:
                return scene.scene["obstacles"], await scene.surface(1), await scene.surface(2)

        obstacles, box, tetrahedron = asyncio.run(look())
        self.assertEqual(obstacles[1], {"shape": "mesh", "position": [0, 1, 0], "vertices": 8, "triangles": 12,
                                        "quaternion": [0, 0, 1, 0], "friction": 0})
        self.assertEqual(obstacles[2], {"shape": "convex", "position": [0, 0, 0], "vertices": 4, "triangles": 4,
                                        "quaternion": [1, 0, 0, 0], "friction": 0})
        # The file's box of 1 x 2 x 3 m; counterclockwise from outside, though the file has it the other way round.
        self.assertEqual((len(box["vertices"]), len(box["triangles"])), (24, 36))
        corners = [box["vertices"][3 * i:3 * i + 3] for i in range(8)]
        self.assertEqual(sorted(corners), sorted([x, y, z] for x in (-0.5, 0.5) for y in (-1, 1) for z in (-1.5, 1.5)))
        for solid, volume in ((box, 6), (tetrahedron, 1 / 6)):
            vertex = [solid["vertices"][i:i + 3] for i in range(0, len(solid["vertices"]), 3)]
            faces = [solid["triangles"][i:i + 3] for i in range(0, len(solid["triangles"]), 3)]
            (six_fold,) = [sum(self.product(*(vertex[corner] for corner in face)) for face in faces)]
            self.assertAlmostEqual(six_fold / 6, volume, places=9)

    @staticmethod
    def product(a, b, c):
        """a . (b x c)"""
        return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]))

    def test_over_http(self):
        status, headers, body = self.server.get("/v1/scenes/solids/meshes/2", Origin="https://show.example")
        self.assertEqual((status, headers["content-type"]), (200, "application/json"))
        self.assertEqual(headers["access-control-allow-origin"], "https://show.example")
        self.assertEqual(len(json.loads(body)["triangles"]), 12)

    def test_what_is_no_mesh_is_not_found(self):
        for place in ["solids/meshes/0", "solids/meshes/3", "solids/meshes/-1", "solids/meshes/1x", "solids/meshes/",
                      "solids/meshes/99999999999999999999", "still/meshes/0", "none/meshes/1", "meshes/1", "solids/meshes/1/meshes/1"]:
            with self.subTest(place):
                self.assertEqual(self.server.get(f"/v1/scenes/{place}")[0], 404)


if __name__ == "__main__":
    unittest.main()
