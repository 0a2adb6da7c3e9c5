"""Viewers at the end of a long way: frames come as often as to those nearby, and a slow viewer's do not queue."""
import asyncio
import contextlib
import re
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


if __name__ == "__main__":
    unittest.main()
