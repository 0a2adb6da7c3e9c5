"""weft::client by way of `weft client --reconnect`: it comes back to what it saw and held, and keeps to what was agreed on."""
import asyncio
import contextlib
import json
import pathlib
import re
import signal
import struct
import tempfile
import unittest

from serving import BINARY, GENEROUS, SCENES, Server

import websockets

PING = {"at": 0.5, "op": "ping", "t": 1}  # when all before it has been taken in
SEATS = [letter * 32 for letter in "abcd"]
SERVER_MS = 4115200  # FRAME's
# 2 x 2 nodes at step 120: the example of PROTOCOL.md, section 4.
FRAME = bytes.fromhex("57454654010101004000010800000000780000000100000000000000000000400"
                      "0cb3e000506000002000200000000000000000000000000"
                      "0000803f0a0000000208021209000000f00f")


def frame_at(f, server_ms):
    """FRAME of another step, sent at `server_ms`."""
    frame = bytearray(FRAME)
    struct.pack_into("<I", frame, 16, f)
    struct.pack_into("<I", frame, 32, server_ms)
    return bytes(frame)


class StandIn:
    """A server that says what a test has it say. `answer(message)`: the members of an `ok`, or a whole message."""

    def __init__(self, answer):
        self.answer, self.connections, self.received = answer, 0, []

    async def __aenter__(self):
        self.server = await websockets.serve(self.handle, "127.0.0.1", 0, subprotocols=["weft.v1"], compression=None)
        self.url = f"ws://127.0.0.1:{self.server.sockets[0].getsockname()[1]}/v1/scenes/flag"
        return self

    async def __aexit__(self, *exception):
        self.server.close()
        await self.server.wait_closed()

    async def handle(self, socket):
        self.socket, seat = socket, SEATS[self.connections]
        self.connections += 1
        await socket.send(json.dumps({"op": "welcome", "protocol": "weft.v1", "minor": 17, "server": "stand-in", "caps": [], "limits": {}}))
        await socket.send(json.dumps({"op": "scene", "name": "flag", "seat": seat, "dt": 0.02, "cloths": [], "balls": []}))
        with contextlib.suppress(websockets.ConnectionClosed):
            async for text in socket:
                message = json.loads(text)
                self.received.append(message)
                if "id" in message:
                    await socket.send(json.dumps({"op": "ok", "re": message["id"], "f": 1, **self.answer(message)}))
                if message["op"] == "hello":
                    await socket.send(FRAME)

    def ops(self, op):
        return [message for message in self.received if message["op"] == op]


class Returning(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def script(self, *messages):
        file = self.folder / "script.jsonl"
        file.write_text("".join(json.dumps(message) + "\n" for message in messages))
        return "--script", file

    async def start(self, url, *arguments):
        process = await asyncio.create_subprocess_exec(BINARY, "client", url, *map(str, arguments), stdout=asyncio.subprocess.PIPE,
                                                       stderr=asyncio.subprocess.PIPE)
        self.addCleanup(lambda: process.returncode is None and process.kill())
        return process

    async def until(self, condition):
        end = asyncio.get_running_loop().time() + GENEROUS
        while not condition():
            self.assertLess(asyncio.get_running_loop().time(), end, "never true")
            await asyncio.sleep(0.02)

    async def line(self, process, words):
        """The next line with these words."""
        while line := (await asyncio.wait_for(process.stdout.readline(), GENEROUS)).decode():
            if all(word in line for word in words):
                return line
        self.fail(f"no line with {words}: {(await process.stderr.read()).decode()}")

    async def end(self, process, code=0):
        process.send_signal(signal.SIGINT)
        _, complaint = await asyncio.wait_for(process.communicate(), GENEROUS)
        self.assertEqual((process.returncode, complaint), (code, b""))

    async def test_it_goes_on_after_the_server_was_killed_with_what_it_held(self):
        options = SCENES / "hung.json", "--data", self.folder / "data"
        with Server(*options) as server:
            client = await self.start(server.url(), "--reconnect", "--camera", 20,
                                      *self.script({"at": 0.2, "op": "cloth.grab", "cloth": 0, "u": 0.5, "v": 0.5}))
            grab = json.loads(await self.line(client, ['"grab":']))["grab"]
            await asyncio.sleep(0.3)  # a reply goes out before what it answers is written
            port = server.port
            server.terminate(signal.SIGKILL)
        with Server(*options, port=port):
            self.assertEqual(json.loads(await self.line(client, ['"grabs":']))["grabs"], [grab])
            await self.line(client, ["frame ", "level 4"])  # the camera, too
            await self.end(client)

    async def test_a_way_that_breaks_while_it_takes_over_what_it_held_loses_nothing(self):
        def answer(message):
            if message["op"] == "seat.resume":
                if server.connections == 2:
                    server.socket.transport.abort()
                return {"grabs": [7] if message["seat"] == SEATS[0] else []}
            return {"grab": 7} if message["op"] == "cloth.grab" else {"caps": []} if message["op"] == "hello" else {}

        async with StandIn(answer) as server:
            client = await self.start(server.url, "--reconnect", *self.script({"at": 0, "op": "cloth.grab", "cloth": 0, "u": 0, "v": 0}, PING))
            await self.until(lambda: server.ops("ping"))
            server.socket.transport.abort()
            await self.until(lambda: len(server.ops("seat.resume")) == 3)
            self.assertEqual([message["seat"] for message in server.ops("seat.resume")], [SEATS[0], SEATS[0], SEATS[1]])
            await self.end(client)

    async def test_a_frame_is_acknowledged_if_that_was_agreed_on(self):
        for caps in ([], ["flow.ack"]):
            async with StandIn(lambda message, caps=caps: {"caps": caps} if message["op"] == "hello" else {}) as server:
                client = await self.start(server.url, *self.script(PING))
                await self.until(lambda: server.ops("ping"))
                self.assertEqual([message["f"] for message in server.ops("ack")], [120] if caps else [])
                await self.end(client)

    async def test_what_waited_until_it_read_again_is_passed_over_for_a_newer_frame_if_there_is_one(self):
        async with StandIn(lambda message: {"caps": ["flow.ack"]} if message["op"] == "hello" else {}) as server:
            client = await self.start(server.url)
            await self.until(lambda: server.ops("ack"))
            for f, server_ms in ((121, SERVER_MS - 5000), (122, SERVER_MS), (123, SERVER_MS - 5000)):
                await server.socket.send(frame_at(f, server_ms))
                await self.until(lambda f=f: server.ops("ack")[-1]["f"] == f)
            await asyncio.sleep(1)  # the last one is given after 0.2 s
            client.send_signal(signal.SIGINT)
            said, _ = await asyncio.wait_for(client.communicate(), GENEROUS)
            self.assertEqual(re.findall(r"frame (\d+) ", said.decode()), ["120", "122", "123"])

    async def test_a_refused_hello_ends_it(self):
        refused = {"op": "error", "code": "range", "path": "/window", "message": "/window is 4; allowed: 1..2"}
        async with StandIn(lambda message: refused if message["op"] == "hello" else {}) as server:
            client = await self.start(server.url, "--reconnect", "--quiet")
            _, complaint = await asyncio.wait_for(client.communicate(), GENEROUS)
            self.assertEqual((client.returncode, complaint), (1, b"weft: /window is 4; allowed: 1..2\n"))

    async def test_without_it_a_connection_that_breaks_ends_it(self):
        async with StandIn(lambda message: {"caps": []} if message["op"] == "hello" else {}) as server:
            client = await self.start(server.url, "--quiet")
            await self.until(lambda: server.ops("hello"))
            server.socket.transport.abort()
            _, complaint = await asyncio.wait_for(client.communicate(), GENEROUS)
            self.assertEqual(client.returncode, 1)
            self.assertEqual((server.connections, len(complaint.splitlines())), (1, 1))


if __name__ == "__main__":
    unittest.main()
