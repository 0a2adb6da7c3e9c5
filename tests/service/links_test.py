"""Viewers at the end of a long way: frames come as often as to those nearby, and a slow viewer's do not queue. Of a narrow one:
what they are sent follows what it carries, and they are told."""
import asyncio
import contextlib
import random
import re
import socket
import time
import unittest

from serving import GENEROUS, SCENES, Server

import weft

WAY = 0.2  # s, there and back


class LongWay:
    """A proxy that hands everything on half of WAY later."""

    def __init__(self, port):
        self.port = port

    async def __aenter__(self):
        self.server = await asyncio.start_server(self.connect, "127.0.0.1", 0)
        return self.server.sockets[0].getsockname()[1]

    async def __aexit__(self, *exception):
        self.server.close()
        await self.server.wait_closed()

    async def connect(self, reader, writer):
        onward_reader, onward_writer = await asyncio.open_connection("127.0.0.1", self.port)
        await asyncio.gather(self.hand_on(reader, onward_writer), self.hand_on(onward_reader, writer))
        await asyncio.sleep(WAY)
        for each in (writer, onward_writer):
            each.close()

    async def hand_on(self, reader, writer):
        loop = asyncio.get_running_loop()

        def deliver(data):
            if not writer.is_closing():
                writer.write(data) if data else writer.close()
        with contextlib.suppress(ConnectionError):
            while data := await reader.read(65536):
                loop.call_later(WAY / 2, deliver, data)
        loop.call_later(WAY / 2, deliver, b"")


class NarrowWay:
    """A proxy that hands on at most `rate` bytes a second of what the server says, and keeps little of it waiting."""
    PIECE = 1024

    def __init__(self, port):
        self.port, self.rate = port, None  # None: as they come

    async def __aenter__(self):
        self.server = await asyncio.start_server(self.connect, "127.0.0.1", 0)
        return self

    async def __aexit__(self, *exception):
        self.server.close()
        await self.server.wait_closed()

    @property
    def url(self):
        return f"ws://127.0.0.1:{self.server.sockets[0].getsockname()[1]}/v1/scenes/hung"

    async def connect(self, reader, writer):
        onward = socket.socket()
        onward.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 * self.PIECE)
        onward.connect(("127.0.0.1", self.port))
        onward_reader, onward_writer = await asyncio.open_connection(sock=onward, limit=self.PIECE)
        await asyncio.gather(self.hand_on(reader, onward_writer, narrow=False), self.hand_on(onward_reader, writer, narrow=True))

    async def hand_on(self, reader, writer, narrow):
        with contextlib.suppress(ConnectionError):
            while data := await reader.read(self.PIECE):
                writer.write(data)
                await writer.drain()
                if narrow and self.rate:
                    await asyncio.sleep(len(data) / self.rate)
        writer.close()


class LossyWay(NarrowWay):
    """1 Mbit/s, 100 ms there and back, 1 % of the server's segments lost. TCP sends what is lost again: what comes after it waits
    for that, as long as Linux' shortest timeout and a way (RFC 6298), where no later segment tells of the loss."""
    RATE, PIECE, HALF_WAY, LOST, STALL = 125_000, 1448, 0.05, 0.01, 0.3  # bytes a second, bytes, s, share, s

    def __init__(self, port, chance):
        super().__init__(port)
        self.chance = chance

    async def hand_on(self, reader, writer, narrow):
        loop = asyncio.get_running_loop()
        with contextlib.suppress(ConnectionError):
            while data := await reader.read(self.PIECE):
                if narrow:
                    await asyncio.sleep(len(data) / self.RATE + (self.STALL if self.chance.random() < self.LOST else 0))
                loop.call_later(self.HALF_WAY, lambda data=data: writer.is_closing() or writer.write(data))
        loop.call_later(self.HALF_WAY, writer.close)


class Links(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        self.server = Server(SCENES / "hung.json")
        self.addCleanup(self.server.end)

    async def frames_in_a_second(self, client, pause=0):
        count, end = 0, time.monotonic() + 1
        while time.monotonic() < end:
            await client.next_frame()
            count += 1
            await asyncio.sleep(pause)
        return count

    async def until(self, what, wanted):
        end = time.monotonic() + GENEROUS
        while not wanted(value := await what()):
            self.assertLess(time.monotonic(), end, f"is {value}")
        return value

    async def test_frames_come_as_often_over_a_long_way(self):
        async with LongWay(self.server.port) as port:
            async with await weft.connect(f"ws://127.0.0.1:{port}/v1/scenes/hung", timeout=GENEROUS) as client:
                for _ in range(3):
                    self.assertGreaterEqual(await client.ping(), WAY)
                # 60 a second are made; with two on the way there were 10.
                await self.until(lambda: self.frames_in_a_second(client), lambda count: count >= 40)

    def sent(self):
        """Frames that the server has sent, to all."""
        return int(re.search(rb"^weft_sent_frames_total (\d+)", self.server.get("/metrics")[2], re.MULTILINE)[1])

    async def test_those_of_a_slow_viewer_do_not_queue(self):
        async with await weft.connect(self.server.url(), timeout=GENEROUS) as client:
            before, taken = self.sent(), 0
            for _ in range(4):
                taken += await self.frames_in_a_second(client, pause=0.25)
            # Each that it takes acknowledges both that were on the way, so that two follow. 60 a second are made.
            self.assertLessEqual(self.sent() - before, 2 * taken + 3)

    async def narrow(self, way, **options):
        """A viewer close to the cloth, by that way, and its newest `stats`."""
        client = await weft.connect(way.url, timeout=GENEROUS, **options)
        self.addAsyncCleanup(client.close)
        await client.camera(distance=0.8)
        await self.until_stats(client, lambda stats: stats["cloths"][0]["level"] == 6)
        return client

    async def until_stats(self, client, wanted):
        end = time.monotonic() + GENEROUS
        while not (client.stats and wanted(client.stats)):
            self.assertLess(time.monotonic(), end, f"is {client.stats}")
            await client.next_frame()
        return client.stats

    async def test_a_narrow_link_gets_a_coarser_level_and_the_finer_one_back(self):
        async with NarrowWay(self.server.port) as way:
            client = await self.narrow(way, coarser=True)
            # Frames of levels 6, 5 and 4 have some 14, 4 and 1.4 kB: 3, 12 and 36 of 60 a second have room.
            way.rate = 50_000
            stats = await self.until_stats(client, lambda stats: "coarser" in stats)
            self.assertEqual(stats["limit"], "link")
            self.assertIn(b'weft_limited_viewers{by="link",scene="hung"} 1', self.server.get("/metrics")[2])
            stats = await self.until_stats(client, lambda stats: stats.get("coarser") == 2)
            frame = await client.next_frame(lambda frame: frame.cloths[0].level == 4)
            self.assertEqual(frame.cloths[0].simulated_level, 6)
            way.rate = None
            stats = await self.until_stats(client, lambda stats: "coarser" not in stats)
            self.assertNotEqual(stats.get("limit"), "link")  # a busy machine may limit it
            await client.next_frame(lambda frame: frame.cloths[0].level == 6)

    async def test_of_what_stands_still_the_finer_level_comes_too(self):
        async with NarrowWay(self.server.port) as way:
            client = await self.narrow(way, coarser=True)
            way.rate = 50_000
            await self.until_stats(client, lambda stats: stats.get("coarser") == 2)
            await client.pause()
            way.rate = None
            frame = await client.next_frame(lambda frame: frame.cloths[0].level == 6)
            self.assertTrue(frame.stamp.paused)

    async def test_a_lossy_link_gets_a_coarser_level_and_keeps_its_viewer(self):
        async with LossyWay(self.server.port, random.Random(1)) as way:
            client = await weft.connect(way.url, timeout=GENEROUS, coarser=True)
            self.addAsyncCleanup(client.close)
            await client.camera(distance=0.8)
            for _ in range(3):
                await client.ping()  # for the frames' age
            await self.until_stats(client, lambda stats: stats.get("coarser", 0) >= 1 and stats["limit"] == "link")
            first, ages = (await client.next_frame()).stamp, []
            while (frame := await client.next_frame()).stamp.time < first.time + 5:
                ages.append(client.age(frame))
            ages.sort()
            print(f"lossy link: 95 % of {len(ages)} frames younger than {ages[len(ages) * 95 // 100]:.0f} ms")
            # 300 steps are made meanwhile; level 4 has 1.4 kB a frame, so that 89 a second would fit if nothing were lost.
            self.assertGreater(len(ages), 30)
            self.assertNotIn(b"weft_closed_viewers_total{", self.server.get("/metrics")[2])

    async def test_without_asking_for_it_no_level_is_lost(self):
        async with NarrowWay(self.server.port) as way:
            client = await self.narrow(way)
            way.rate = 50_000
            await self.until_stats(client, lambda stats: stats.get("limit") == "link")
            dropped = client.stats["dropped"]
            stats = await self.until_stats(client, lambda stats: stats["dropped"] > dropped + 120)  # 2 s
            self.assertEqual((stats["cloths"][0]["level"], "coarser" in stats), (6, False))

    async def test_a_slow_viewer_is_told_that_it_is(self):
        async with await weft.connect(self.server.url(), timeout=GENEROUS, coarser=True) as client:
            await client.camera(distance=0.8)
            end = time.monotonic() + GENEROUS
            while client.stats.get("limit") != "client":
                self.assertLess(time.monotonic(), end, f"is {client.stats}")
                await client.next_frame()
                await asyncio.sleep(0.25)
            self.assertNotIn("coarser", client.stats)


if __name__ == "__main__":
    unittest.main()
