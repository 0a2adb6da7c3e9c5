"""Connections that end, stall, flood or are too many: what the server does to them, and that the others do not notice."""
import asyncio
import json
import unittest

from serving import GENEROUS, SANITIZED, SCENES, Server, client_frame, server_frames

import weft
import websockets


def raw(server, scene="hung", **options):
    return websockets.connect(server.url(scene), subprotocols=["weft.v1"], compression=None, **options)


class Connections(unittest.IsolatedAsyncioTestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(SCENES / "hung.json", SCENES / "still.json", "--connections-per-address", 0)
        cls.addClassCleanup(cls.server.end)

    async def connect(self, scene="hung", **options):
        client = await weft.connect(self.server.url(scene), timeout=GENEROUS, **options)
        self.addAsyncCleanup(client.close)
        return client

    async def close_code(self, message):
        """What the server closes with after this message; meanwhile a viewer keeps seeing."""
        watcher = await self.connect()
        f = (await watcher.next_frame()).stamp.f
        async with raw(self.server) as connection:
            await connection.send(message)
            with self.assertRaises(websockets.ConnectionClosed):
                while True:
                    await asyncio.wait_for(connection.recv(), GENEROUS)
            code = connection.close_code
        await watcher.next_frame(lambda frame: frame.stamp.f > f)
        return code

    async def test_binary_is_1003(self):
        self.assertEqual(await self.close_code(b"\x00\x01"), 1003)

    async def test_beyond_16_kib_is_1009(self):
        self.assertEqual(await self.close_code('{"op":"ping","t":' + "1" * 16384 + "}"), 1009)

    async def test_16_kib_are_read(self):
        async with raw(self.server) as connection:
            text = '{"op":"ping","id":5,"t":1}'
            await connection.send(text + " " * (16384 - len(text)))
            while not isinstance(message := await connection.recv(), str) or json.loads(message)["op"] != "pong":
                pass

    def test_bad_utf8_is_1007(self):
        connection, _ = self.server.raw_socket()
        with connection:
            connection.sendall(client_frame(1, b"\xff\xfe"))
            received = b""
            while chunk := connection.recv(65536):
                received += chunk
        self.assertEqual(received[-4:], b"\x88\x02" + (1007).to_bytes(2, "big"))

    def test_frames_before_the_answer_are_400(self):
        request = (b"GET /v1/scenes/hung HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                   b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                   b"Sec-WebSocket-Protocol: weft.v1\r\n\r\n")
        answer = self.server.request(request + client_frame(1, b'{"op":"pause"}'))
        self.assertTrue(answer.startswith(b"HTTP/1.1 400 "), answer[:40])

    def close_after(self, sent):
        """Code of the server's close after these bytes, and how many pongs came before."""
        connection, _ = self.server.raw_socket()
        with connection:
            try:
                connection.sendall(sent)
            except OSError:  # closed while it still sends
                pass
            frames = list(server_frames(connection))
        self.assertEqual(frames[-1][0], 8, "the last frame is no close")
        return int.from_bytes(frames[-1][1][:2], "big"), sum(opcode == 10 for opcode, _ in frames)

    def test_close_codes_that_may_not_be_sent_are_1002(self):  # RFC 6455, section 7.4
        for code in [0, 999, 1004, 1005, 1006, 1015, 1016, 2999, 5000, 65535]:
            with self.subTest(code):
                self.assertEqual(self.close_after(client_frame(8, code.to_bytes(2, "big") + b"why"))[0], 1002)
        for code in [1000, 1001, 1011, 3000, 4999]:
            with self.subTest(code):
                self.assertEqual(self.close_after(client_frame(8, code.to_bytes(2, "big")))[0], code)
        self.assertEqual(self.close_after(client_frame(8))[0], 1000)

    def test_floods_of_control_frames_and_fragments_are_1008(self):
        # 120 at once are allowed, which is told as messages_per_second.
        opened = client_frame(1, final=False)
        for name, sent, pongs in [("pings", client_frame(9) * 1000, 120), ("pongs", client_frame(10) * 1000, 0),
                                  ("empty fragments", opened + client_frame(0, final=False) * 1000, 0),
                                  ("small fragments", opened + client_frame(0, b"x", final=False) * 1000, 0)]:
            with self.subTest(name):
                code, answered = self.close_after(sent)
                self.assertEqual(code, 1008)
                self.assertLessEqual(answered, pongs + 12)  # and those of a tenth of a second
                self.assertGreaterEqual(answered, pongs)

    async def test_ordinary_pings_and_fragments_are_answered(self):
        async with raw(self.server) as connection:
            for _ in range(10):
                await asyncio.wait_for(await connection.ping(), GENEROUS)
            await connection.send(iter(['{"op":"ping",', '"id":3,', '"t":1}']))  # one message, a fragment each
            while not isinstance(message := await connection.recv(), str) or json.loads(message)["op"] != "pong":
                pass

    async def test_newest_frame_after_a_stall(self):
        """A viewer that acknowledges nothing for a while is sent nothing, and then the newest."""
        watcher = await self.connect()
        async with raw(self.server) as slow:
            async def frames_until(re):
                """The frames that come before the answer to request `re`."""
                frames = []
                while isinstance(message := await slow.recv(), bytes) or json.loads(message).get("re") != re:
                    if isinstance(message, bytes):
                        frames.append(weft.decode_frame(message).stamp.f)
                return frames
            await slow.send('{"op":"hello","id":1,"caps":["flow.ack"],"window":2}')
            await frames_until(1)
            f = (await watcher.next_frame()).stamp.f
            before = self.server.memory_kib()
            newest = (await watcher.next_frame(lambda frame: frame.stamp.f >= f + 120)).stamp.f
            after = self.server.memory_kib()
            await slow.send('{"op":"ping","id":2,"t":0}')
            sent = await frames_until(2)
            self.assertEqual(len(sent), 2)  # the window
            if not SANITIZED:
                self.assertLess(after - before, 1024)
            await slow.send(json.dumps({"op": "ack", "f": sent[-1]}))
            while not isinstance(message := await slow.recv(), bytes):
                pass
            # The watcher may have been served just before it in the same step.
            self.assertGreaterEqual(weft.decode_frame(message).stamp.f, newest - 1)

    async def test_memory_stays_when_viewers_do_not_read(self):
        if SANITIZED:
            self.skipTest("a sanitizer keeps freed memory")
        watcher = await self.connect()
        for _ in range(10):
            stalled, _ = self.server.raw_socket(receive_buffer=4096)  # which nobody reads
            self.addCleanup(stalled.close)
        f = (await watcher.next_frame()).stamp.f
        await watcher.next_frame(lambda frame: frame.stamp.f >= f + 60)
        before = self.server.memory_kib()
        await watcher.next_frame(lambda frame: frame.stamp.f >= f + 300)
        # 240 frames of 3 KiB for each of ten: 7 MiB, were they kept.
        self.assertLess(self.server.memory_kib() - before, 2048)

    async def test_4004_when_control_messages_are_not_read(self):
        watcher = await self.connect("still")
        connection, _ = self.server.raw_socket("/v1/scenes/still", receive_buffer=4096)
        with connection:
            request = client_frame(1, b'{"op":"scene.list","id":1}')

            async def flood():
                with self.assertRaises(OSError):  # the server ends the connection
                    while True:
                        await asyncio.get_running_loop().sock_sendall(connection, request)
                        await asyncio.sleep(0.01)
            connection.setblocking(False)
            await asyncio.wait_for(flood(), 2 * GENEROUS)
        self.server.wait_for_log("control messages are not read")
        await watcher.next_frame()

    async def test_the_257th_viewer_is_503(self):
        async with await weft.connect(self.server.url("hung"), timeout=GENEROUS) as visitor:
            sockets = []
            try:
                while len(sockets) < 256:
                    connection, status = self.server.raw_socket("/v1/scenes/still")
                    sockets.append(connection)
                    self.assertEqual(status, 101)
                self.assertEqual(self.server.upgrade("/v1/scenes/still"), 503)
                with self.assertRaises(weft.WeftError) as refused:
                    await visitor.join_scene("still")
                self.assertEqual(refused.exception.code, "limit")
                await visitor.next_frame()
            finally:
                for connection in sockets:
                    connection.close()
            # Their places are free again.
            while (await visitor.list_scenes())[1]["viewers"] > 0:
                await visitor.next_frame()
            await visitor.join_scene("still")

    async def test_a_viewer_that_vanishes_frees_its_place(self):
        watcher = await self.connect()
        before = (await watcher.list_scenes())[0]["viewers"]
        connection = await raw(self.server)
        self.assertEqual((await watcher.list_scenes())[0]["viewers"], before + 1)
        connection.transport.abort()
        while (await watcher.list_scenes())[0]["viewers"] != before:
            await watcher.next_frame()


if __name__ == "__main__":
    unittest.main()
