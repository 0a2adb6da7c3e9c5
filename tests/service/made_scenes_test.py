"""Scenes that clients make and end: what is made, what is refused and why, and that nobody else is disturbed."""
import asyncio
import contextlib
import copy
import http.client
import json
import pathlib
import tempfile
import threading
import unittest

from serving import GENEROUS, SANITIZED, SCENES, Server

import weft

DOCUMENT = json.loads((SCENES / "hung.json").read_text())


class MadeScenes(unittest.IsolatedAsyncioTestCase):
    def start(self, *arguments):
        server = Server(SCENES / "still.json", *arguments)
        self.addCleanup(server.end)
        return server

    def ask(self, server, method, name, body=None, **headers):
        """Status and, where it is JSON, the body of the answer."""
        connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=GENEROUS)
        with contextlib.closing(connection):
            connection.request(method, f"/v1/scenes/{name}", body if isinstance(body, (bytes, type(None))) else json.dumps(body),
                               {key.replace("_", "-"): value for key, value in headers.items()})
            answer = connection.getresponse()
            text = answer.read().decode()
            return answer.status, json.loads(text) if answer.getheader("content-type") == "application/json" else text

    def named(self, server):
        return [scene["name"] for scene in json.loads(server.get("/v1/scenes")[2])["scenes"]]

    def changed(self, **members):
        return {**copy.deepcopy(DOCUMENT), **members}

    async def test_is_seen_commanded_and_ended(self):
        server = self.start()
        self.assertEqual(self.ask(server, "PUT", "mine", DOCUMENT), (201, "made\n"))
        self.assertEqual(self.named(server), ["still", "mine"])
        client = await weft.connect(server.url("mine"), timeout=GENEROUS)
        self.addAsyncCleanup(client.close)
        self.assertEqual(client.scene["title"], DOCUMENT["title"])
        await client.add_ball([0, 0, 1], 0.2)
        await client.next_frame(lambda frame: len(frame.balls) == 1)
        self.assertEqual(self.ask(server, "DELETE", "mine"), (204, ""))
        self.assertEqual(self.named(server), ["still"])
        with self.assertRaisesRegex(weft.WeftError, "4005"):
            while True:
                await client.next_frame()
        self.assertEqual(self.ask(server, "DELETE", "mine")[0], 404)
        self.assertEqual(server.upgrade("/v1/scenes/mine"), 404)
        # The name is free again, once its viewers have gone.
        for _ in range(100):
            status, _ = self.ask(server, "PUT", "mine", DOCUMENT)
            if status != 409:
                break
            await asyncio.sleep(0.1)
        self.assertEqual(status, 201)

    def test_problems_are_told_as_check_tells_them(self):
        server = self.start()
        document = self.changed()
        document["cloths"][0]["size"] = [-1, 2]
        document["cloths"][0]["colour"] = "red"
        status, answer = self.ask(server, "PUT", "bad", document)
        self.assertEqual(status, 422)
        self.assertEqual({problem["path"] for problem in answer["problems"]}, {"/cloths/0/size/0", "/cloths/0/colour"})
        for body, words in [(b"{", "line 1"), (b"", "line 1"), (b"\xff", ""), (b"[]", "")]:
            status, answer = self.ask(server, "PUT", "bad", body)
            self.assertEqual(status, 422)
            self.assertIn(words, answer["problems"][0]["message"])
        for name in ("Bad", "a_b", "x" * 65, "a%20b"):
            status, answer = self.ask(server, "PUT", name, DOCUMENT)
            self.assertEqual((status, answer["message"]), (422, "a scene's name must be 1..64 of a-z, 0-9 and -"))
        self.assertEqual(self.named(server), ["still"])

    def test_files_of_the_server_cannot_be_read(self):
        server = self.start()
        for file in ("/etc/passwd", "../../etc/passwd", "box.obj"):
            document = self.changed(colliders=[{"type": "mesh", "position": [0, 0, 0], "file": file}])
            status, answer = self.ask(server, "PUT", "spy", document)
            self.assertEqual(status, 422)
            self.assertEqual([problem["path"] for problem in answer["problems"]], ["/colliders/0/file"])
            self.assertIn("is given by a scene that is not a file itself", answer["problems"][0]["message"])
        status, answer = self.ask(server, "PUT", "spy", self.changed(cloths=[{"nodes": {"file": "drape.obj"}}]))
        self.assertEqual((status, [problem["path"] for problem in answer["problems"]]), (422, ["/cloths/0/nodes/file"]))
        self.assertIn("is given by a scene that is not a file itself", answer["problems"][0]["message"])
        self.assertEqual(self.named(server), ["still"])

    def test_what_is_too_much_is_refused(self):
        server = self.start("--made-scenes", 2, "--made-nodes", 65 * 65 + 17 * 17, "--made-colliders", 3, "--scene-bytes", 5000,
                            "--made-work", 2e6)
        fine = DOCUMENT  # levels 4 to 6: 65 x 65 nodes
        small = self.changed()
        small["cloths"][0]["levels"] = {"min": 4, "max": 4}
        self.assertEqual(self.ask(server, "PUT", "a", fine)[0], 201)
        status, answer = self.ask(server, "PUT", "b", fine)
        self.assertEqual(status, 413)
        self.assertIn("4225 nodes at its finest levels, beside 4225 of others", answer["message"])
        balls = [{"type": "ball", "position": [i, 0, 9], "radius": 0.1} for i in range(4)]
        status, answer = self.ask(server, "PUT", "b", {**small, "colliders": balls})
        self.assertEqual((status, answer["problems"]), (413, []))
        self.assertIn("4 balls and obstacles; allowed: 3", answer["message"])
        heavy = {**small, "integrator": {"type": "xpbd", "substeps": 10000}}  # 17 x 17 x 10,000 = 2.9e6
        self.assertEqual(self.ask(server, "PUT", "b", heavy)[0], 422)
        self.assertEqual(self.ask(server, "PUT", "b", {**small, "title": "x" * 5000})[0], 413)
        self.assertEqual(self.ask(server, "PUT", "a", small)[0], 409)
        self.assertEqual(self.ask(server, "PUT", "still", small)[0], 409)
        self.assertEqual(self.ask(server, "PUT", "b", small)[0], 201)
        status, answer = self.ask(server, "PUT", "c", small)
        self.assertEqual(status, 503)
        self.assertIn("2 scenes, the most allowed", answer["message"])
        self.assertEqual(self.ask(server, "DELETE", "still")[0], 409)
        self.assertEqual(self.ask(server, "DELETE", "a")[0], 204)
        self.assertEqual(self.ask(server, "PUT", "c", small)[0], 201)

    def test_two_at_once_of_one_name_make_one(self):
        server = self.start()
        statuses = []
        threads = [threading.Thread(target=lambda: statuses.append(self.ask(server, "PUT", "one", DOCUMENT)[0])) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(sorted(statuses), [201] + 7 * [409])

    def test_only_for_admins_and_from_pages_that_may_connect(self):
        tokens = {role: f"a-token-to-{role}-000000" for role in ("view", "control", "admin")}
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "tokens.json"
            file.write_text(json.dumps({"tokens": [{"role": role, "token": token} for role, token in tokens.items()]}))
            server = self.start("--tokens", file)
        for method in ("PUT", "DELETE"):
            self.assertEqual(self.ask(server, method, "mine", DOCUMENT)[0], 401)
            for role in ("view", "control"):
                self.assertEqual(self.ask(server, method, "mine", DOCUMENT, Authorization=f"Bearer {tokens[role]}")[0], 403)
        admin = {"Authorization": f"Bearer {tokens['admin']}"}
        self.assertEqual(self.ask(server, "PUT", "mine", DOCUMENT, Origin="https://evil.example", **admin)[0], 403)
        self.assertEqual(self.ask(server, "PUT", "mine", DOCUMENT, **admin)[0], 201)
        self.assertEqual(self.ask(server, "DELETE", "mine", Origin="https://evil.example", **admin)[0], 403)
        self.assertEqual(self.ask(server, "DELETE", "mine", **admin)[0], 204)

    async def test_its_metrics_come_and_go_with_it(self):
        server = self.start()
        for _ in range(3):
            self.assertEqual(self.ask(server, "PUT", "mine", DOCUMENT)[0], 201)
            self.assertIn(b'scene="mine"', server.get("/metrics")[2])
            self.assertEqual(self.ask(server, "DELETE", "mine")[0], 204)
            self.assertNotIn(b'scene="mine"', server.get("/metrics")[2])

    async def test_others_are_answered_while_a_scene_is_made(self):
        server = self.start("--made-work", 1e9, "--made-nodes", 10**7)
        heavy = self.changed(integrator={"type": "xpbd", "substeps": 500 if SANITIZED else 10000})  # making it takes a second or more
        heavy["cloths"][0]["levels"] = {"min": 7, "max": 7}
        async with await weft.connect(server.url("still"), timeout=GENEROUS) as client:
            making = asyncio.create_task(asyncio.to_thread(self.ask, server, "PUT", "heavy", heavy))
            answers = 0
            while not making.done():
                await client.send("ping", t=0)
                answers += 1
                await asyncio.sleep(0.02)
            self.assertEqual((await making)[0], 201)
            # Were they to wait for the making, there would be the one or two from before it began.
            self.assertGreater(answers, 4)


if __name__ == "__main__":
    unittest.main()
