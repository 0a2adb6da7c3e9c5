"""A seat outlives its connection: who comes back, after a kill of the server too, has the hands it had; others cannot take them."""
import asyncio
import signal
import unittest

from kept import SCENE, Kept
from serving import GENEROUS, SANITIZED, Server

import weft


class Seats(Kept):
    async def test_a_client_is_back_within_2_s_with_what_it_held(self):
        server = self.start("--data", self.data)
        port = server.port
        client = await weft.connect(server.url(), timeout=GENEROUS, reconnect=True)
        self.addAsyncCleanup(client.close)
        await client.camera(distance=20)
        grabs = [await client.grab(0, 0.5, share) for share in (0.3, 0.6)]
        instance, seat = client.welcome["instance"], client.scene["seat"]
        frame = await client.next_frame(lambda frame: frame.stamp.f > 20)
        server.terminate(signal.SIGKILL)
        server.process.wait()
        await asyncio.sleep(0.6)  # attempts fail
        killed = asyncio.get_running_loop().time()
        after = Server(SCENE, "--data", self.data, port=port)
        self.addCleanup(after.end)
        back = await client.next_frame(lambda later: later.stamp.epoch > frame.stamp.epoch)
        if not SANITIZED:
            self.assertLess(asyncio.get_running_loop().time() - killed, 2)
        self.assertGreaterEqual(back.stamp.f, frame.stamp.f)
        for _ in range(100):  # its frames may come before it has resumed
            try:
                await client.move_grab(grabs[0], [0, 0.2, 0.3])
                break
            except weft.WeftError as error:
                self.assertEqual(error.code, "not_found")
                await asyncio.sleep(0.02)
        await client.release(grabs[1])
        self.assertNotEqual(client.welcome["instance"], instance)
        self.assertNotEqual(client.scene["seat"], seat)

    async def test_hands_of_whom_nobody_hears_any_more_let_go_after_5_s(self):
        server = self.start()
        watcher = await self.join(server)
        holder = await self.join(server)
        grab = await holder.grab(0, 0.5, 0.5)
        seat = holder.scene["seat"]
        holder._socket.transport.abort()
        await self.alone(watcher)
        heir = await self.join(server)
        self.assertEqual((await heir.resume_seat(seat))["grabs"], [grab])
        await heir.move_grab(grab, [0, 0, 1])
        with self.assertRaisesRegex(weft.WeftError, "nobody is waited for"):
            await heir.resume_seat(seat)
        seat = heir.scene["seat"]
        heir._socket.transport.abort()
        await asyncio.sleep(5.5)
        with self.assertRaisesRegex(weft.WeftError, "too late"):
            await watcher.resume_seat(seat)
        leaver = await self.join(server)
        await leaver.grab(0, 0.5, 0.5)
        seat = leaver.scene["seat"]
        await leaver.close()  # in order: it does not come back
        await self.alone(watcher)
        with self.assertRaises(weft.WeftError):
            await watcher.resume_seat(seat)

    async def alone(self, client):
        """Waits until the scene knows that all others have left."""
        for _ in range(100):
            if await self.viewers(client) == 1:
                return
        self.fail("there are other viewers still")

    async def viewers(self, client):
        before = client.stats
        while client.stats is before:
            await client.next_frame()
        return client.stats["viewers"]


if __name__ == "__main__":
    unittest.main()
