"""The Python client against the shared vectors, and against a small server of its own."""
import asyncio
import contextlib
import http
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "protocol" / "clients" / "python"))
import numpy as np  # noqa: E402
import weft  # noqa: E402
import websockets  # noqa: E402

LIMIT = 30.0  # s, for what must come: far beyond what it takes


def load(name):
    return json.loads((ROOT / "protocol" / "vectors" / name).read_text())


FRAMES, MESSAGES, SERVER = load("frames.json"), load("messages.json"), load("server_messages.json")["good"]
WELCOME = next(message for message in SERVER if message["op"] == "welcome")
SCENE = next(message for message in SERVER if message["op"] == "scene")


def frame_bytes(name):
    return bytes.fromhex(next(vector["hex"] for vector in FRAMES["good"] if vector["name"] == name))


def frame_of(f, server_ms=4115200):
    """A frame whose header says step `f`, sent at `server_ms`."""
    data = bytearray(frame_bytes("small"))
    struct.pack_into("<I", data, 16, f)
    struct.pack_into("<I", data, 32, server_ms)
    return bytes(data)


class Vectors(unittest.TestCase):
    def test_script_writes_the_vectors(self):
        subprocess.run([sys.executable, ROOT / "tests" / "protocol" / "make_vectors.py", "--check"], check=True)

    def test_good_frames(self):
        for vector in FRAMES["good"]:
            with self.subTest(vector["name"]):
                frame, expect = weft.decode_frame(bytes.fromhex(vector["hex"])), vector["expect"]
                stamp = weft.Stamp(expect["f"], expect["epoch"], expect["time"], expect["server_ms"],
                                   bool(expect["flags"] & 2), bool(expect["flags"] & 4))
                self.assertEqual(frame.stamp, stamp)
                self.assertEqual(len(frame.cloths), len(expect["cloths"]))
                for cloth, wanted in zip(frame.cloths, expect["cloths"]):
                    for name in ("cloth", "level", "simulated_level", "rows", "cols", "quantum"):
                        self.assertEqual(getattr(cloth, name), wanted[name], name)
                    self.assertEqual(cloth.positions.tobytes().hex(), wanted["positions_f32"])
                    self.assertEqual(cloth.torn, wanted["torn"])
                balls = [weft.Ball(ball["ball"], tuple(ball["position"]), ball["radius"], ball["motion"]) for ball in expect["balls"]]
                self.assertEqual(frame.balls, balls)
                obstacles = [weft.MovedObstacle(each["obstacle"], tuple(each["position"]), tuple(each["quaternion"]))
                             for each in expect["obstacles"]]
                self.assertEqual(frame.obstacles, obstacles)

    def test_bad_frames(self):
        for vector in FRAMES["bad"]:
            with self.subTest(vector["name"]):
                with self.assertRaises(weft.WeftError) as caught:
                    weft.decode_frame(bytes.fromhex(vector["hex"]))
                self.assertEqual((caught.exception.code, str(caught.exception)), ("bad_frame", vector["error"]))

    def test_every_beginning_of_a_frame_is_refused(self):
        data = frame_bytes("several")
        for size in range(len(data)):
            with self.assertRaises(weft.WeftError):
                weft.decode_frame(data[:size])

    def test_positions_by_row_and_column(self):
        cloth = weft.decode_frame(frame_bytes("small")).cloths[0]  # computed by hand: hand_frame.json
        self.assertEqual([cloth.at(0, 0), cloth.at(0, 1), cloth.at(1, 0), cloth.at(1, 1)],
                         [(0, 1, 0), (1, 1, 0), (0, 0, 0), (1, 0, 255)])

    def test_positions_are_one_array(self):
        cloth = weft.decode_frame(frame_bytes("small")).cloths[0]  # as above
        self.assertEqual((cloth.positions.dtype, cloth.positions.flags["C_CONTIGUOUS"], cloth.rows, cloth.cols), (np.float32, True, 2, 2))
        np.testing.assert_array_equal(cloth.positions, [[[0, 1, 0], [1, 1, 0]], [[0, 0, 0], [1, 0, 255]]])

    def test_messages_take_numpy(self):
        text = weft.message_text("ball.move", {"ball": np.int64(7), "position": np.float32([1, 2, 3])})
        self.assertEqual(json.loads(text), {"op": "ball.move", "ball": 7, "position": [1, 2, 3]})
        with self.assertRaises(weft.WeftError) as caught:
            weft.message_text("ball.move", {"ball": 7, "position": np.array([1, 2, np.nan])})
        self.assertEqual(caught.exception.code, "range")
        with self.assertRaisesRegex(TypeError, "allowed are numbers"):
            weft.message_text("ball.move", {"ball": {1, 2}})

    def test_builds_the_good_messages(self):
        for vector in MESSAGES["good"]:
            with self.subTest(vector["text"]):
                text = weft.message_text(vector["op"], vector["members"], vector.get("id"))
                self.assertEqual(json.loads(text), json.loads(vector["text"]))

    def test_numbers_that_are_not_finite_are_refused(self):
        for value in (float("nan"), float("inf")):
            with self.assertRaises(weft.WeftError) as caught:
                weft.message_text("camera", {"distance": value})
            self.assertEqual(caught.exception.code, "range")


class Server:
    """Greets, and answers as `answer(message)` says; None: not at all. `received` queues what comes."""

    def __init__(self, answer=lambda message: {}, greet=True, after_hello=None, **options):
        self.answer, self.greet, self.after_hello, self.options = answer, greet, after_hello, options
        self.received = asyncio.Queue()
        self.socket = None

    async def __aenter__(self):
        self.server = await websockets.serve(self.handle, "127.0.0.1", 0, subprotocols=["weft.v1"], **self.options)
        self.url = f"ws://127.0.0.1:{self.server.sockets[0].getsockname()[1]}/v1/scenes/flag"
        return self

    async def __aexit__(self, *exception):
        self.server.close()
        await self.server.wait_closed()

    async def handle(self, socket):
        self.socket = socket
        with contextlib.suppress(websockets.ConnectionClosed):
            if self.greet:
                await socket.send(json.dumps(WELCOME))
                await socket.send(json.dumps(SCENE))
            async for text in socket:
                await self.receive(socket, json.loads(text))

    async def receive(self, socket, message):
        self.received.put_nowait(message)
        extra = {"caps": message["caps"]} if message["op"] == "hello" else self.answer(message)
        if "id" in message and extra is not None:
            await socket.send(json.dumps({"op": "ok", "re": message["id"], "f": 1, **extra}))
        if message["op"] == "hello" and self.after_hello:
            await socket.send(self.after_hello)

    async def expect(self, op):
        """The next message of that op."""
        while True:
            message = await asyncio.wait_for(self.received.get(), LIMIT)
            if message["op"] == op:
                return message


class Client(unittest.IsolatedAsyncioTestCase):
    async def test_connects_with_hello(self):
        async with Server() as server, await weft.connect(server.url, client="test", window=3) as scene:
            self.assertEqual((scene.welcome, scene.scene), (WELCOME, SCENE))
            self.assertEqual(server.socket.subprotocol, "weft.v1")
            self.assertEqual(server.socket.path, "/v1/scenes/flag")
            self.assertEqual(await server.expect("hello"), {"op": "hello", "id": 1, "client": "test", "caps": ["flow.ack"], "window": 3})

    async def test_asks_for_coarser_levels_only_if_told_to(self):
        async with Server() as server, await weft.connect(server.url, coarser=True, window=0):
            self.assertEqual(await server.expect("hello"), {"op": "hello", "id": 1, "caps": ["flow.level"]})

    async def test_asks_for_compact_frames_only_if_told_to(self):
        async with Server() as server, await weft.connect(server.url, compact=True, window=0):
            self.assertEqual(await server.expect("hello"), {"op": "hello", "id": 1, "caps": ["grid.rice"]})

    async def test_the_surface_of_a_mesh_is_asked_for_beside_the_scene(self):
        surface, asked = {"vertices": [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], "triangles": [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]}, []

        async def process(path, headers):
            if "Upgrade" in headers:
                return None
            asked.append(path)
            if path.endswith("/1"):
                return http.HTTPStatus.OK, [], json.dumps(surface).encode()
            return http.HTTPStatus.NOT_FOUND, [], b"there is no such mesh"

        async with Server(process_request=process) as server, await weft.connect(server.url) as scene:
            self.assertEqual(await scene.surface(1), surface)
            with self.assertRaises(weft.WeftError) as caught:
                await scene.surface(2)
        self.assertEqual(caught.exception.code, "not_found")
        self.assertEqual(asked, [f"/v1/scenes/{SCENE['name']}/meshes/{obstacle}" for obstacle in (1, 2)])

    async def test_each_method_sends_its_operation(self):
        answers = {"ball.add": {"ball": 7}, "cloth.grab": {"grab": 3}, "obstacle.grab": {"grab": 4}, "scene.list": {"scenes": [{"name": "flag"}]}, "ping": {"op": "pong"}}
        async with Server(lambda message: answers.get(message["op"], {})) as server, await weft.connect(server.url, window=0) as scene:
            await scene.camera(distance=5)
            await scene.camera(eye=[0, 1, 2])
            await scene.camera(eye=(0, 1, 2), target=(0, 1, 0), half_angle=0.5)
            self.assertEqual(await scene.add_ball([0, 1, 2], 0.2), 7)
            await scene.add_ball((0, 1, 2), 0.2, velocity=(0, 0, 1), motion="dynamic", mass=2, friction=0.5)
            await scene.move_ball(7, [1, 1, 1])
            await scene.throw_ball(7, [0, 0, -6])
            await scene.remove_ball(7)
            await scene.move_obstacle(0, [0, 1, 0])
            await scene.move_obstacle(1, (0, 1, 0), quaternion=(0, 1, 0, 0))
            await scene.throw_obstacle(0, [0, 1, 0])
            await scene.throw_obstacle(1, (0, 1, 0), spin=(0, 2, 0))
            self.assertEqual(await scene.grab(0, 0.5, 1, max_force=20), 3)
            self.assertEqual(await scene.grab_obstacle(2), 4)
            self.assertEqual(await scene.grab_obstacle(1, point=(0, 0.1, 0), position=(0, 1, 0), max_force=20), 4)
            await scene.move_grab(3, [0, 1, 0])
            await scene.release(3)
            await scene.pin(0, 0.5, 1)
            await scene.unpin(0, 0.5, 1)
            await scene.tune_cloth(1, structural=250, rigidity=(1e-5, 2e-5, 0))
            await scene.set_friction(0.4, ball=7)
            await scene.set_friction(0.5, obstacle=0)
            await scene.set_friction(0)
            await scene.set_effect("gravity", False)
            await scene.tune_effect("aerodynamics", drag=0.5, lift=0)
            await scene.set_wind([0, 0, -1], 3)
            await scene.set_wind([0, 0, -1], 3, gusts=0.25)
            await scene.set_wind([0, 0, -1], 3, turbulence=0.5)
            await scene.set_wind([0, 0, -1], 3, time_scale=2, length_scale=0.2)
            await scene.set_wind_zone(1, [0, 0, -2])
            await scene.set_quality(max_error=0.01)
            await scene.set_quality(max_ms=2)
            await scene.set_quality()
            await scene.ask_cost()
            await scene.pause()
            await scene.step(2)
            await scene.resume()
            await scene.reset()
            self.assertEqual(await scene.list_scenes(), [{"name": "flag"}])
            self.assertGreaterEqual(await scene.ping(), 0)
            await scene.join_scene("curtain")
            sent = [server.received.get_nowait() for _ in range(server.received.qsize())]
        self.assertEqual([message.pop("id") for message in sent], list(range(1, len(sent) + 1)))
        self.assertIsInstance(sent[-2].pop("t"), float)
        self.assertEqual(sent, [
            {"op": "camera", "distance": 5}, {"op": "camera", "eye": [0, 1, 2]},
            {"op": "camera", "eye": [0, 1, 2], "target": [0, 1, 0], "half_angle": 0.5}, {"op": "ball.add", "position": [0, 1, 2], "radius": 0.2},
            {"op": "ball.add", "position": [0, 1, 2], "radius": 0.2, "velocity": [0, 0, 1], "motion": "dynamic", "mass": 2, "friction": 0.5},
            {"op": "ball.move", "ball": 7, "position": [1, 1, 1]}, {"op": "ball.throw", "ball": 7, "velocity": [0, 0, -6]},
            {"op": "ball.remove", "ball": 7}, {"op": "obstacle.move", "obstacle": 0, "position": [0, 1, 0]},
            {"op": "obstacle.move", "obstacle": 1, "position": [0, 1, 0], "quaternion": [0, 1, 0, 0]},
            {"op": "obstacle.throw", "obstacle": 0, "velocity": [0, 1, 0]},
            {"op": "obstacle.throw", "obstacle": 1, "velocity": [0, 1, 0], "spin": [0, 2, 0]},
            {"op": "cloth.grab", "cloth": 0, "u": 0.5, "v": 1, "max_force": 20}, {"op": "obstacle.grab", "obstacle": 2},
            {"op": "obstacle.grab", "obstacle": 1, "point": [0, 0.1, 0], "position": [0, 1, 0], "max_force": 20}, {"op": "grab.move", "grab": 3, "position": [0, 1, 0]},
            {"op": "grab.release", "grab": 3}, {"op": "cloth.pin", "cloth": 0, "u": 0.5, "v": 1},
            {"op": "cloth.unpin", "cloth": 0, "u": 0.5, "v": 1},
            {"op": "cloth.tune", "cloth": 1, "parameters": {"structural": 250, "rigidity": [1e-5, 2e-5, 0]}},
            {"op": "friction.set", "friction": 0.4, "ball": 7}, {"op": "friction.set", "friction": 0.5, "obstacle": 0},
            {"op": "friction.set", "friction": 0}, {"op": "effect.set", "effect": "gravity", "on": False},
            {"op": "effect.tune", "effect": "aerodynamics", "parameters": {"drag": 0.5, "lift": 0}},
            {"op": "wind.set", "direction": [0, 0, -1], "speed": 3},
            {"op": "wind.set", "direction": [0, 0, -1], "speed": 3, "gusts": 0.25},
            {"op": "wind.set", "direction": [0, 0, -1], "speed": 3, "turbulence": 0.5},
            {"op": "wind.set", "direction": [0, 0, -1], "speed": 3, "time_scale": 2, "length_scale": 0.2},
            {"op": "wind.zone.set", "zone": 1, "velocity": [0, 0, -2]},
            {"op": "quality", "max_error": 0.01}, {"op": "quality", "max_ms": 2}, {"op": "quality"}, {"op": "cost"}, {"op": "pause"},
            {"op": "step", "count": 2}, {"op": "resume"}, {"op": "reset"}, {"op": "scene.list"}, {"op": "ping"},
            {"op": "scene.join", "scene": "curtain"}])

    async def test_an_error_is_raised_and_the_connection_goes_on(self):
        refusal = {"op": "error", "code": "range", "path": "/speed", "message": "/speed is 1000; allowed: 0..100 (m/s)"}
        async with Server(lambda message: refusal if message["op"] == "wind.set" else {}) as server, \
                await weft.connect(server.url) as scene:
            with self.assertRaises(weft.WeftError) as caught:
                await scene.set_wind([0, 0, -1], 1000)
            error = caught.exception
            self.assertEqual((error.code, error.path, str(error)), ("range", "/speed", refusal["message"]))
            self.assertEqual((await scene.pause())["op"], "ok")

    async def test_answers_find_their_requests_in_any_order(self):
        async with Server(lambda message: None) as server, await weft.connect(server.url, window=0) as scene:
            first, second = (asyncio.create_task(scene.send("ping", t=t)) for t in (1, 2))
            pings = [await server.expect("ping"), await server.expect("ping")]
            for ping in reversed(pings):
                await server.socket.send(json.dumps({"op": "pong", "re": ping["id"], "t": ping["t"], "f": 1, "time": 0}))
            self.assertEqual([(await first)["t"], (await second)["t"]], [1, 2])

    async def test_a_ping_tells_how_old_frames_are(self):
        def answer(message):
            return {"op": "pong", "re": message["id"], "t": message["t"], "f": 1, "time": 0, "server_ms": 2 ** 32 - 50}
        async with Server(answer) as server, await weft.connect(server.url, window=0) as scene:
            def frame(server_ms):
                return weft.Frame(weft.Stamp(1, 1, 0.0, server_ms, False, False), [], [], [])
            self.assertTrue(math.isnan(scene.age(frame(0))))
            round_trip = await scene.ping()
            since = scene.age(frame(2 ** 32 - 50))  # the pong's own time
            self.assertTrue(0 <= since <= 1000 * round_trip + 1000, since)
            self.assertAlmostEqual(scene.age(frame(2 ** 32 - 60050)) - since, 60000, delta=5000)
            self.assertAlmostEqual(scene.age(frame(59950)) - since, -60000, delta=5000)  # its clock has wrapped round since

    async def test_frames_are_acknowledged_as_they_are_taken(self):
        async with Server() as server, await weft.connect(server.url) as scene:
            for f in (5, 6):
                await server.socket.send(frame_of(f))
                self.assertEqual((await scene.next_frame(timeout=LIMIT)).stamp.f, f)
                self.assertEqual(await server.expect("ack"), {"op": "ack", "f": f})

    async def test_the_newest_frame_wins(self):
        async with Server() as server, await weft.connect(server.url) as scene:
            for f in (1, 2, 3):
                await server.socket.send(frame_of(f))
            await scene.pause()  # answered after the frames: they have all come
            self.assertEqual((await scene.next_frame()).stamp.f, 3)
            self.assertEqual(await server.expect("ack"), {"op": "ack", "f": 3})

    async def test_what_waited_until_the_program_read_again_is_passed_over_for_a_newer_frame(self):
        async with Server() as server, await weft.connect(server.url) as scene:
            await server.socket.send(frame_of(1, 2 ** 32 - 2000))
            self.assertEqual((await scene.next_frame(timeout=LIMIT)).stamp.f, 1)
            waiting = asyncio.create_task(scene.next_frame(timeout=LIMIT))
            await server.socket.send(frame_of(2, 2 ** 32 - 7000))
            self.assertEqual([(await server.expect("ack"))["f"] for _ in range(2)], [1, 2])
            await server.socket.send(frame_of(3, 0))  # its clock has wrapped round since
            self.assertEqual((await waiting).stamp.f, 3)

    async def frame_within(self, scene, seconds):
        try:
            return await scene.next_frame(timeout=seconds)
        except weft.WeftError as error:
            self.assertEqual(error.code, "timeout")

    async def test_where_nothing_newer_comes_what_waited_is_given(self):
        async with Server() as server, await weft.connect(server.url) as scene:
            await server.socket.send(frame_of(1, 10000))
            await scene.next_frame(timeout=LIMIT)
            await server.socket.send(frame_of(2, 5000))
            waited = 0  # the 0.2 s are its own, however often it is asked for
            while (frame := await self.frame_within(scene, 0.05)) is None:
                waited += 1
            self.assertEqual(frame.stamp.f, 2)
            self.assertGreater(waited, 0)
            self.assertEqual([(await server.expect("ack"))["f"] for _ in range(2)], [1, 2])
            await scene.pause()
            self.assertEqual((await server.received.get())["op"], "pause")  # and acknowledged once

    async def test_a_frame_right_behind_the_answer_to_hello_is_acknowledged(self):
        async with Server(after_hello=frame_of(9)) as server, await weft.connect(server.url, window=1) as scene:
            self.assertEqual((await scene.next_frame(timeout=LIMIT)).stamp.f, 9)
            self.assertEqual(await server.expect("ack"), {"op": "ack", "f": 9})

    async def test_without_flow_control_nothing_is_acknowledged(self):
        async with Server() as server, await weft.connect(server.url, window=0) as scene:
            await server.socket.send(frame_of(3))
            self.assertEqual((await scene.next_frame(timeout=LIMIT)).stamp.f, 3)
            await scene.pause()
            self.assertEqual((await server.received.get())["op"], "pause")
            self.assertTrue(server.received.empty())

    async def test_a_malformed_frame_is_raised_and_the_next_one_comes(self):
        async with Server() as server, await weft.connect(server.url) as scene:
            await server.socket.send(b"\0")
            with self.assertRaises(weft.WeftError) as caught:
                await scene.next_frame(timeout=LIMIT)
            self.assertEqual(caught.exception.code, "bad_frame")
            await server.socket.send(frame_of(2))
            self.assertEqual((await scene.next_frame(timeout=LIMIT)).stamp.f, 2)

    async def test_next_frame_waits_for_the_frame_it_is_asked_for(self):
        async with Server() as server, await weft.connect(server.url) as scene:
            wanted = asyncio.create_task(scene.next_frame(lambda frame: frame.stamp.f >= 2, LIMIT))
            for f in (1, 2):
                await server.socket.send(frame_of(f))
                await server.expect("ack")
            self.assertEqual((await wanted).stamp.f, 2)
            with self.assertRaises(weft.WeftError) as caught:
                await scene.next_frame(lambda frame: False, 0.02)
            self.assertEqual(caught.exception.code, "timeout")

    async def test_other_messages_are_heard_and_the_scene_remembered(self):
        heard = []
        async with Server() as server, await weft.connect(server.url, on_message=lambda message: heard.append(message["op"])) as scene:
            for message in SERVER:
                if message["op"] in ("event", "stats", "notice"):
                    await server.socket.send(json.dumps(message))
            await server.socket.send(json.dumps({**SCENE, "name": "curtain"}))
            await scene.pause()
            self.assertEqual(list(dict.fromkeys(heard)), ["welcome", "scene", "event", "stats", "notice"])
            self.assertEqual((scene.scene["name"], scene.stats["viewers"]), ("curtain", 2))

    async def test_iteration_ends_when_the_server_stops(self):
        async with Server() as server, await weft.connect(server.url) as scene:
            await server.socket.send(frame_of(1))
            await scene.pause()
            await server.socket.close(1001, "the server stops")
            self.assertEqual([frame.stamp.f async for frame in scene], [1])
            with self.assertRaises(weft.WeftError) as caught:
                await scene.pause()
            self.assertEqual(str(caught.exception), "connection closed with 1001: the server stops")

    async def test_a_lost_connection_is_raised(self):
        async with Server(lambda message: None) as server, await weft.connect(server.url) as scene:
            request = asyncio.create_task(scene.pause())
            await server.expect("pause")
            server.socket.transport.abort()
            with self.assertRaises(weft.WeftError) as caught:
                await scene.next_frame(timeout=LIMIT)
            self.assertEqual(caught.exception.code, "closed")
            with self.assertRaises(weft.WeftError) as caught:
                await request
            self.assertEqual(caught.exception.code, "closed")

    async def test_a_way_that_breaks_while_it_takes_over_what_it_held_loses_nothing(self):
        seats, resumed = ["a" * 32, "b" * 32, "c" * 32], []

        class Breaking(Server):
            connections = 0

            async def handle(self, socket):
                self.socket, seat = socket, seats[self.connections]
                self.connections += 1
                await socket.send(json.dumps(WELCOME))
                await socket.send(json.dumps({**SCENE, "seat": seat}))
                with contextlib.suppress(websockets.ConnectionClosed):
                    async for text in socket:
                        await self.receive(socket, json.loads(text))

        def answer(message):
            if message["op"] == "seat.resume":
                resumed.append(message["seat"])
                if server.connections == 2:
                    server.socket.transport.abort()
                return {"grabs": [7] if message["seat"] == seats[0] else []}
            return {"grab": 7} if message["op"] == "cloth.grab" else {}

        async with Breaking(answer) as server, await weft.connect(server.url, reconnect=True) as scene:
            await scene.grab(0, 0.5, 0.5)
            server.socket.transport.abort()
            end = asyncio.get_running_loop().time() + LIMIT
            while len(resumed) < 3:
                self.assertLess(asyncio.get_running_loop().time(), end, resumed)
                await asyncio.sleep(0.02)
            self.assertEqual(resumed, [seats[0], seats[0], seats[1]])

    async def test_it_comes_back_though_the_way_breaks_again_meanwhile(self):
        cameras = []

        def answer(message):
            if message["op"] != "camera":
                return {}
            cameras.append(message)
            if len(cameras) == 2:  # the first attempt to come back
                server.socket.transport.abort()
                return None
            return {}

        async with Server(answer, after_hello=frame_bytes("small")) as server, await weft.connect(server.url, reconnect=True) as scene:
            await scene.camera(distance=3)
            await scene.next_frame(timeout=LIMIT)
            server.socket.transport.abort()

            async def third():
                while len(cameras) < 3:
                    await asyncio.sleep(0.02)
            await asyncio.wait_for(third(), LIMIT)
            self.assertEqual([camera["distance"] for camera in cameras], [3, 3, 3])
            await scene.next_frame(timeout=LIMIT)

    async def test_closing_says_1000_and_fails_open_requests(self):
        async with Server(lambda message: None) as server:
            scene = await weft.connect(server.url)
            request = asyncio.create_task(scene.pause())
            await server.expect("pause")
            await scene.close()
            with self.assertRaises(weft.WeftError) as caught:
                await request
            self.assertEqual(caught.exception.code, "closed")
            await server.socket.wait_closed()
            self.assertEqual(server.socket.close_code, 1000)
            self.assertEqual([frame async for frame in scene], [])

    async def test_a_request_without_answer_fails_in_time(self):
        # Long enough for a busy machine to connect in.
        async with Server(lambda message: None) as server, await weft.connect(server.url, timeout=2, window=0) as scene:
            with self.assertRaises(weft.WeftError) as caught:
                await scene.pause()
            self.assertEqual((caught.exception.code, str(caught.exception)), ("timeout", "no answer to pause within 2 s"))

    async def test_a_server_that_does_not_greet_is_given_up_in_time(self):
        async with Server(greet=False) as server:
            with self.assertRaises(weft.WeftError) as caught:
                await weft.connect(server.url, timeout=0.05)
            self.assertEqual(caught.exception.code, "timeout")

    async def test_a_server_that_refuses_and_no_server(self):
        async def refuse(path, headers):
            return http.HTTPStatus.NOT_FOUND, [], b""
        async with Server(process_request=refuse) as server:
            with self.assertRaises(weft.WeftError) as caught:
                await weft.connect(server.url)
            self.assertEqual(caught.exception.code, "connect")
            self.assertIn("404", str(caught.exception))
        with self.assertRaises(weft.WeftError) as caught:
            await weft.connect(server.url)
        self.assertEqual(caught.exception.code, "connect")


class DataSet(unittest.TestCase):
    def frame(self, f, time, height, balls=()):
        cloth = weft.Cloth(0, 1, 1, 0.0, np.full((2, 2, 3), height, np.float32))
        return weft.Frame(weft.Stamp(f, 0, time, 0, False, False), [cloth], list(balls), [])

    def test_velocities_and_balls_that_come(self):
        ball = weft.Ball(7, (1.0, 2.0, 3.0), 0.5, "dynamic")
        # s = t^2 at 1, 1.5, 3 s: differences of second order give 2 t inside, those of first order the slope at the ends.
        frames = [self.frame(0, 1.0, 1.0), self.frame(1, 1.5, 2.25), self.frame(2, 3.0, 9.0, [ball])]
        with tempfile.TemporaryDirectory() as folder:
            weft.write_npz(pathlib.Path(folder) / "set.npz", frames, wind=[[1, 0, 0], [2, 0, 0], [3, 0, 0]])
            with np.load(pathlib.Path(folder) / "set.npz") as data:
                np.testing.assert_allclose(data["velocities"][:, 0, 0, 1], [2.5, 3.0, 4.5], rtol=1e-6)
                np.testing.assert_array_equal(data["time"], [1, 1.5, 3])
                np.testing.assert_array_equal(data["wind"][:, 0], [1, 2, 3])
                np.testing.assert_array_equal(data["balls"], [[[np.nan] * 4]] * 2 + [[[1, 2, 3, 0.5]]])

    def test_what_makes_no_data_set_is_refused(self):
        one, two = self.frame(0, 0.0, 0), self.frame(1, 1.0, 1)
        for frames, wind, cloth, told in [([one], [0, 0, 0], 0, "2 or more"), ([one, two], [0, 0], 0, "wind has the shape"),
                                          ([one, two], [0, 0, 0], 4, "cloth 4 is in 0 of 2 frames"), ([two, one], [0, 0, 0], 0, "after 1 s")]:
            with self.assertRaisesRegex(ValueError, told):
                weft.write_npz("unwritten.npz", frames, wind, cloth)


if __name__ == "__main__":
    unittest.main()
