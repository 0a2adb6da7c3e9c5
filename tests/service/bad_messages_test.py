"""Malformed and impossible messages: each gets its exact error, none changes anything or ends the connection, and another
viewer keeps receiving frames all the while."""
import json
import unittest

from serving import GENEROUS, SCENES, Server

import weft
import websockets

# What is sent (the scene runs, has no ball and no wind), then the error's code, path and message, and the id it answers.
# Sections 2, 3 and 6 of PROTOCOL.md say what is allowed.
BAD = [
    ('{"op":"pause"', "bad_json", "", "not JSON, seen at byte 14", None),
    ("hello", "bad_json", "", "not JSON, seen at byte 1", None),
    ('{"op":"ping","id":1,"t":NaN}', "bad_json", "", "not JSON, seen at byte 25", 1),
    ('{"op":"ping","id":1,"t":' + "[" * 16 + "]" * 16 + "}", "bad_json", "/t" + "/0" * 15, "nested deeper than 16 levels", 1),
    ('{"op":"camera","id":2,"distance":1,"distance":2}', "bad_json", "/distance", "/distance is given twice", 2),
    ('[{"op":"pause"}]', "bad_type", "", 'the message is [{"op":"pause"}]; allowed: an object with op', None),
    ('{"op":"pause","id":"3"}', "bad_type", "/id", '/id is "3"; allowed: an integer 1..2147483647', None),
    ('{"op":"camera","id":4,"distance":"5"}', "bad_type", "/distance",
     '/distance is "5"; allowed: a number 0..1000000 (m)', 4),
    ('{"op":"camera","id":5,"eye":[0,null,0]}', "bad_type", "/eye/1",
     "/eye/1 is null; allowed: a number -1000000..1000000 (m)", 5),
    ('{"op":"camera","id":6,"distance":1,"eye":[0,0,1]}', "conflict", "/eye",
     "/eye is given beside /distance; allowed: exactly one of /distance and /eye", 6),
    ('{"op":"camera","id":7}', "missing", "/distance",
     "/distance is missing; allowed: exactly one of /distance and /eye", 7),
    ('{"op":"pause","id":8,"now":true}', "unknown_member", "/now", "/now is true; allowed: in pause only op, id", 8),
    ('{"op":"ball.add","id":9,"position":[0,0,0],"radius":-0.2}', "range", "/radius",
     "/radius is -0.2; allowed: 0.01..10 (m)", 9),
    ('{"op":"ball.add","id":10,"position":[0,1e30,0],"radius":0.2}', "range", "/position/1",
     "/position/1 is 1e+30; allowed: -1000..1000 (m)", 10),
    ('{"op":"wind.set","id":11,"direction":[0,0,0],"speed":1}', "range", "/direction",
     "/direction is [0,0,0]; allowed: any direction but the zero vector", 11),
    ('{"op":"wind.set","id":12,"direction":[0,0,-1],"speed":1000}', "range", "/speed",
     "/speed is 1000; allowed: 0..100 (m/s)", 12),
    ('{"op":"step","id":13,"count":601}', "range", "/count", "/count is 601; allowed: 1..600", 13),
    # Well formed, but not now or not here.
    ('{"op":"step","id":14}', "conflict", "", "step is only for a paused scene", 14),
    ('{"op":"ball.throw","id":15,"ball":7,"velocity":[0,0,1]}', "not_found", "/ball",
     "/ball is 7; the scene has no such ball", 15),
    ('{"op":"scene.join","id":16,"scene":"attic"}', "not_found", "/scene", 'there is no scene named "attic"', 16),
    ('{"op":"wind.set","id":17,"direction":[0,0,-1],"speed":1}', "unavailable", "",
     "the scene has no wind effect (paper_wind or aerodynamics)", 17),
]


class BadMessages(unittest.IsolatedAsyncioTestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(SCENES / "still.json")
        cls.addClassCleanup(cls.server.end)

    async def test_each_gets_its_error_and_others_keep_seeing(self):
        told = []
        watcher = await weft.connect(self.server.url("still"), on_message=told.append, timeout=GENEROUS)
        self.addAsyncCleanup(watcher.close)
        async with websockets.connect(self.server.url("still"), subprotocols=["weft.v1"], compression=None) as socket:
            async def next_of(*ops):
                while True:
                    message = await socket.recv()
                    if isinstance(message, str) and json.loads(message)["op"] in ops:
                        return json.loads(message)
            f = (await watcher.next_frame()).stamp.f
            for text, code, path, message, re in BAD:
                with self.subTest(text):
                    await socket.send(text)
                    expected = {"op": "error", "code": code, "path": path, "message": message}
                    if re is not None:
                        expected["re"] = re
                    self.assertEqual(await next_of("ok", "error", "pong"), expected)
                    frame = await watcher.next_frame()
                    self.assertGreater(frame.stamp.f, f)
                    self.assertFalse(frame.stamp.paused)
                    f = frame.stamp.f
            # The connection is as good as before.
            await socket.send('{"op":"ping","id":99,"t":0.5}')
            self.assertEqual((await next_of("ok", "error", "pong"))["t"], 0.5)
        self.assertEqual([message for message in told if message["op"] == "event"], [])

    async def test_too_many_messages_are_dropped(self):
        """Beyond 120 a second: the error `rate`, then the flood is read no faster than that."""
        scene = await weft.connect(self.server.url("still"), timeout=GENEROUS)
        self.addAsyncCleanup(scene.close)
        refused = []
        for _ in range(200):
            try:
                await scene.send("ping", t=0)
            except weft.WeftError as error:
                refused.append(error.code)
                break
        else:
            # Slower than 120 a second is allowed; a machine so slow shows nothing here.
            self.skipTest("this machine does not get to 120 round trips a second")
        self.assertEqual(refused, ["rate"])
        await scene.next_frame()


if __name__ == "__main__":
    unittest.main()
