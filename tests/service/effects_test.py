"""effect.tune, cloth.tune and friction.set over the wire: what is tuned acts from the step that is told, all viewers are told, wrong values are refused."""
import asyncio
import math
import unittest

from serving import GENEROUS, SCENES, Server

import weft


class Effects(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        self.server = Server(SCENES / "falling.json")
        self.addCleanup(self.server.end)

    async def connect(self):
        """A client and the list of what it is told beside frames and replies."""
        told = []
        client = await weft.connect(self.server.url("falling"), on_message=told.append, timeout=GENEROUS)
        self.addAsyncCleanup(client.close)
        return client, told

    async def event(self, told, kind):
        """The newest of that kind. Frames may overtake events: it is waited for."""
        async with asyncio.timeout(GENEROUS):
            while not (events := [each for each in told if each.get("kind") == kind]):
                await asyncio.sleep(0.01)
        return events[-1]

    async def height_at(self, scene, f):
        """Of the cloth's centre at step f, once the scene stands there."""
        frame = await scene.next_frame(lambda frame: frame.stamp.f == f)
        return frame.cloths[0].at(8, 8)[1]

    async def begin(self):
        """A viewer of the scene at its start, which stands still."""
        scene, told = await self.connect()
        await scene.pause()
        await scene.reset()
        return scene, told

    async def steps(self, scene, count):
        return await self.height_at(scene, (await scene.step(count))["f"])

    async def test_without_gravity_the_cloth_keeps_its_velocity(self):
        scene, _ = await self.begin()
        fallen = await self.steps(scene, 30)
        ok = await scene.tune_effect("gravity", acceleration=[0, 0, 0])
        self.assertEqual(ok["f"], 31)
        # 9.81 m/s2 for 0.5 s, then evenly on: 4.905 m/s; 1 mm is for the lattice of the frames.
        for _ in range(3):
            further = await self.steps(scene, 30)
            self.assertAlmostEqual(fallen - further, 4.905 * 0.5, delta=1e-3)
            fallen = further

    async def test_terminal_speed_goes_as_the_root_of_drag(self):
        scene, _ = await self.begin()
        await scene.tune_effect("aerodynamics", air_density=1.225)
        for drag in (1.2, 4.8):
            await scene.tune_effect("aerodynamics", drag=drag)
            before = await self.steps(scene, 180)
            after = await self.steps(scene, 60)
            # T16: sqrt(2 rho g / (rho_air C_D)), face on.
            self.assertAlmostEqual(before - after, math.sqrt(2 * 0.1 * 9.81 / (1.225 * drag)), delta=2e-3)

    async def test_all_viewers_are_told_and_a_reset_brings_the_scenes_own_back(self):
        scene, _ = await self.begin()
        watcher, told = await self.connect()
        own = scene.scene["parameters"]
        self.assertEqual(own, {"gravity": {"acceleration": [0, -9.81, 0]},
                               "aerodynamics": {"air_density": 0, "drag": 1.2, "lift": 1.2}})
        self.assertEqual(scene.scene["tunable"]["gravity"], {"acceleration": {"range": [-10000, 10000], "unit": "m/s2"}})
        await scene.tune_effect("aerodynamics", drag=0.5, lift=0)
        await scene.step(1)
        await watcher.next_frame(lambda frame: frame.stamp.f == 1)
        event = await self.event(told, "tune")
        self.assertEqual((event["effect"], event["parameters"]), ("aerodynamics", {"air_density": 0, "drag": 0.5, "lift": 0}))
        late, _ = await self.connect()
        self.assertEqual(late.scene["parameters"]["aerodynamics"], event["parameters"])
        await scene.reset()
        await watcher.next_frame(lambda frame: frame.stamp.epoch == 3)
        self.assertEqual((await self.event(told, "reset"))["parameters"], own)
        self.assertEqual(len([each for each in told if each.get("kind") == "reset"]), 1, "the reset before it joined is not its own")

    async def test_wrong_values_are_refused(self):
        scene, _ = await self.begin()
        for effect, parameters, code, path in [
                ("tearing", {"strength": 1}, "unavailable", "/effect"),
                ("aerodynamics", {"drug": 1}, "unknown_member", "/parameters/drug"),
                ("aerodynamics", {"drag": 101}, "range", "/parameters/drag"),
                ("aerodynamics", {"drag": "much"}, "bad_type", "/parameters/drag"),
                ("gravity", {"acceleration": [0, 1]}, "bad_type", "/parameters/acceleration"),
                ("gravity", {}, "range", "/parameters")]:
            with self.subTest(effect=effect, parameters=parameters):
                with self.assertRaises(weft.WeftError) as refused:
                    await scene.tune_effect(effect, **parameters)
                self.assertEqual((refused.exception.code, refused.exception.path), (code, path))

    async def test_a_material_and_friction_are_told_to_all(self):
        scene, _ = await self.begin()
        watcher, told = await self.connect()
        cloth = scene.scene["cloths"][0]
        self.assertEqual(cloth["material"], {"structural": 100, "structural_weft": 100, "shear": 10, "bending": 0.01})  # the scene damps nothing
        self.assertEqual(scene.scene["material_tunable"]["bending"], {"range": [0, 1e9], "unit": "N/m"})
        ball = await scene.add_ball([0, -3, 0], radius=0.3, friction=0.25)
        await scene.tune_cloth(0, structural=700, bending=0)
        await scene.set_friction(0.9, ball=ball)
        await scene.step(1)
        await watcher.next_frame(lambda frame: frame.stamp.f == 1)
        events = {kind: await self.event(told, kind) for kind in ("ball.add", "cloth.tune", "friction")}
        # Told as it is when it is told: the change that came after it may be in it.
        self.assertIn([each["friction"] for each in events["ball.add"]["balls"]], ([0.25], [0.9]))
        self.assertEqual(events["cloth.tune"]["material"], {"structural": 700, "structural_weft": 700, "shear": 10, "bending": 0})
        self.assertEqual([each["friction"] for each in events["friction"]["balls"]], [0.9])
        self.assertEqual(events["friction"]["frictions"], [])
        for wrong in [scene.tune_cloth(0, damping=1), scene.tune_cloth(1, shear=1), scene.set_friction(11),
                      scene.set_friction(1, ball=99), scene.set_friction(1, obstacle=0)]:
            with self.assertRaises(weft.WeftError) as refused:
                await wrong
            self.assertIn(refused.exception.code, ("unknown_member", "not_found", "range"))

    async def test_counts_towards_the_rate(self):
        scene, _ = await self.begin()
        with self.assertRaises(weft.WeftError) as refused:
            for i in range(1000):
                await scene.tune_effect("aerodynamics", drag=i % 2)
            self.skipTest("this machine does not get to 120 round trips a second")
        self.assertEqual(refused.exception.code, "rate")


if __name__ == "__main__":
    unittest.main()
