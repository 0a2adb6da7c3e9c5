"""`--network-threads`: connections are spread among threads, and whatever concerns them all reaches each of them."""
import asyncio
import json
import pathlib
import re
import signal
import tempfile
import unittest

from serving import GENEROUS, SCENES, Server, client_frame, head_of

import weft

THREADS, VIEWERS = 3, 9
DOCUMENT = (SCENES / "hung.json").read_bytes()


class NetworkThreads(unittest.IsolatedAsyncioTestCase):
    def start(self, *arguments, threads=THREADS):
        server = Server(SCENES / "hung.json", "--network-threads", threads, *arguments)
        self.addCleanup(server.end)
        return server

    async def viewers(self, server, scene="hung", count=VIEWERS):
        clients = [await weft.connect(server.url(scene), timeout=GENEROUS) for _ in range(count)]
        for client in clients:
            self.addAsyncCleanup(client.close)
        return clients

    def seconds_of_threads(self, server):
        text = server.get("/metrics")[2].decode()
        return {int(thread): float(value) for thread, value in
                re.findall(r'^weft_network_cpu_seconds_total\{thread="(\d+)"\} (\S+)$', text, re.MULTILINE)}

    async def test_each_has_viewers_and_all_see_the_same(self):
        server = self.start()
        clients = await self.viewers(server)
        before = self.seconds_of_threads(server)
        self.assertEqual(sorted(before), list(range(THREADS)))
        # A command of one is seen by all, whichever thread they are on.
        ball = await clients[0].add_ball([0, 0.5, 1], 0.1)
        for client in clients:
            frame = await client.next_frame(lambda frame: any(each.ball == ball for each in frame.balls))
            self.assertGreater(frame.cloths[0].positions.size, 0)
        for _ in range(30):
            for client in clients:
                await client.next_frame()
        after = self.seconds_of_threads(server)
        for thread in range(THREADS):
            self.assertGreater(after[thread], before[thread], f"thread {thread} serves nobody")
        metrics = server.get("/metrics")[2].decode()
        self.assertIn(f"weft_viewers {VIEWERS}\n", metrics)

    async def test_an_ended_scene_and_a_stopping_server_close_those_of_every_thread(self):
        server = self.start()
        request = head_of("PUT", "/v1/scenes/mine", {"Host": f"127.0.0.1:{server.port}", "Content-Length": str(len(DOCUMENT)),
                                                     "Connection": "close"}) + DOCUMENT
        self.assertIn(b"201 Created", server.request(request))
        in_mine, in_hung = await self.viewers(server, "mine"), await self.viewers(server)
        self.assertEqual(server.get("/v1/scenes/mine", method="DELETE")[0], 204)
        for client in in_mine:
            with self.assertRaisesRegex(weft.WeftError, "4005"):
                while True:
                    await client.next_frame()
        for client in in_hung:
            await client.next_frame()
        server.terminate(signal.SIGTERM)
        for client in in_hung:
            with self.assertRaises(StopAsyncIteration):  # 1001
                while True:
                    await client.__anext__()
        self.assertEqual(await asyncio.to_thread(server.process.wait, GENEROUS), 0)

    async def test_limits_count_over_all_threads(self):
        server = self.start("--connections-per-address", THREADS + 1)
        sockets = [server.raw_socket() for _ in range(THREADS + 1)]
        self.assertEqual([status for _, status in sockets], [101] * (THREADS + 1))
        self.assertEqual(server.upgrade("/v1/scenes/hung"), 429)
        sockets[0][0].close()
        for _ in range(100):  # until the server has seen it
            if (status := server.upgrade("/v1/scenes/hung")) == 101:
                break
            await asyncio.sleep(0.05)
        self.assertEqual(status, 101)
        for connection, _ in sockets[1:]:
            connection.close()

    async def test_tokens_read_anew_hold_on_every_thread(self):
        tokens = self.file_with(json.dumps({"tokens": [{"role": "view", "token": "token-of-number-one"}]}))
        server = self.start("--tokens", tokens)
        def statuses(token):
            return {server.get("/v1/scenes", Authorization=f"Bearer {token}")[0] for _ in range(2 * THREADS)}
        self.assertEqual(statuses("token-of-number-one"), {200})
        tokens.write_text(json.dumps({"tokens": [{"role": "view", "token": "token-of-number-two"}]}))
        server.terminate(signal.SIGHUP)
        server.wait_for_log("read anew")
        self.assertEqual((statuses("token-of-number-one"), statuses("token-of-number-two")), ({401}, {200}))

    def file_with(self, text):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name) / "tokens.json"
        path.write_text(text)
        return path

    async def test_one_that_does_not_read_holds_up_nobody_on_its_thread(self):
        server = self.start(threads=1)
        stalled, status = server.raw_socket(receive_buffer=4096)
        self.assertEqual(status, 101)
        # Near, and without acknowledgements: it is sent all that there is, until its socket takes no more.
        stalled.sendall(client_frame(1, b'{"op":"camera","distance":0.8}'))
        (client,) = await self.viewers(server, count=1)
        first = await client.next_frame()
        last = await client.next_frame(lambda frame: frame.stamp.f >= first.stamp.f + 120)
        self.assertGreaterEqual(last.stamp.f, first.stamp.f + 120)
        # It reads again: what it gets is whole messages, and the newest frame comes soon.
        received = b""
        stalled.settimeout(GENEROUS)
        newest = last.stamp.f
        frames = []
        while not frames or frames[-1] < newest:
            received += stalled.recv(65536)
            while (message := whole_message(received)) is not None:
                opcode, payload, received = message
                self.assertIn(opcode, (1, 2, 9))
                if opcode == 2:
                    frames.append(weft.decode_frame(payload).stamp.f)
        self.assertEqual(frames, sorted(set(frames)))
        stalled.close()


def whole_message(received):
    """Opcode, payload and what follows, of the frame that `received` begins with; None while it is not whole."""
    if len(received) < 2:
        return None
    size, begin = received[1] & 127, 2
    if size >= 126:
        begin = 4 if size == 126 else 10
        if len(received) < begin:
            return None
        size = int.from_bytes(received[2:begin], "big")
    if len(received) < begin + size:
        return None
    return received[0] & 15, received[begin:begin + size], received[begin + size:]


if __name__ == "__main__":
    unittest.main()
