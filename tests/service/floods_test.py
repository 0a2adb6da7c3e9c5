"""Clients that send as much as they may, or more: the others keep their places and their frames."""
import asyncio
import json
import unittest

from serving import GENEROUS, SCENES, Server

import weft
import websockets

WIND = '{"op":"wind.set","direction":[1,0,0],"speed":%g}'


def raw(server, scene="hung"):
    return websockets.connect(server.url(scene), subprotocols=["weft.v1"], compression=None, close_timeout=1)


class Floods(unittest.IsolatedAsyncioTestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(SCENES / "hung.json")
        cls.addClassCleanup(cls.server.end)

    async def connect(self, **options):
        client = await weft.connect(self.server.url(), timeout=GENEROUS, **options)
        self.addAsyncCleanup(client.close)
        return client

    async def test_nobody_is_closed_for_what_others_may_do(self):
        """Three clients change the wind as often as a second's messages allow, in one write each: 360 changes at once."""
        winds = []
        viewers = [await self.connect(on_message=lambda message: winds.append(message) if "wind" in message else None)
                   for _ in range(10)]
        floods = [await self.enterAsync(raw(self.server)) for _ in range(3)]
        for _ in range(3):
            for flood in floods:
                for i in range(39):
                    await flood.send(WIND % (0.1 * i))
        for flood in floods:  # a pong comes after what was asked before it
            await flood.send('{"op":"ping","t":1}')
            async for message in flood:
                if '"pong"' in str(message):
                    break
        last = await viewers[0].set_wind([0, 0, -1], 7)
        for viewer in viewers:
            await viewer.next_frame(lambda frame: frame.stamp.f >= last["f"] + 30)
            self.assertIsNone(viewer._lost)
        changes = [message for message in winds if message["op"] == "event"]
        self.assertEqual(changes[-1]["wind"]["speed"], 7)

    async def enterAsync(self, context):
        entered = await context.__aenter__()
        self.addAsyncCleanup(context.__aexit__, None, None, None)
        return entered

    async def test_a_flooder_is_closed_with_4003(self):
        viewer = await self.connect()
        async with raw(self.server) as flood:
            async def read():
                async for _ in flood:
                    pass
            reading = asyncio.create_task(read())
            with self.assertRaises(websockets.ConnectionClosed):
                while True:
                    await flood.send('{"op":"ping","t":1}')
                    await asyncio.sleep(0)  # or the client would not read while it sends
            with self.assertRaises(websockets.ConnectionClosed):
                await asyncio.wait_for(reading, GENEROUS)
        self.assertEqual((flood.close_code, flood.close_reason), (4003, "more messages a second than allowed, for too long"))
        f = (await viewer.next_frame()).stamp.f
        await viewer.next_frame(lambda frame: frame.stamp.f > f)

    async def test_balls_as_large_as_the_scene_do_not_stop_it(self):
        viewer = await self.connect()
        for k in range(20):
            await viewer.post("ball.add", position=[0, -1, k / 1000], radius=2, motion="dynamic", mass=10000)
        f = (await viewer.next_frame()).stamp.f
        await viewer.next_frame(lambda frame: frame.stamp.f >= f + 30, 4 * GENEROUS)  # each at the limit of work
        with self.assertRaises(weft.WeftError) as refused:
            await viewer.add_ball([0, 0, 0], 10)
        self.assertIn(refused.exception.code, ("range", "limit"))


class Viewers(unittest.TestCase):
    def test_the_number_of_viewers_is_the_servers_choice(self):
        server = Server("--viewers", 2, SCENES / "hung.json")
        self.addCleanup(server.end)
        sockets = [server.raw_socket() for _ in range(2)]
        self.assertEqual([status for _, status in sockets], [101, 101])
        self.assertEqual(server.upgrade("/v1/scenes/hung"), 503)
        received = b""
        while b'"limits"' not in received or b"}}" not in received:
            received += sockets[0][0].recv(4096)
        limits = json.loads(b'{"limits"' + received.split(b'"limits"')[1].split(b"}")[0] + b"}}")["limits"]
        self.assertEqual(limits["viewers"], 2)
        for connection, _ in sockets:
            connection.close()


if __name__ == "__main__":
    unittest.main()
