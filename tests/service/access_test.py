"""Who may do what: tokens, wherever they are shown, and the commands of each role."""
import asyncio
import contextlib
import hashlib
import json
import pathlib
import signal
import socket
import tempfile
import unittest

from serving import BINARY, GENEROUS, ROOT, SCENES, Server, page_directory

import weft

ROLES = ["view", "control", "admin"]
TOKENS = {role: f"the-token-to-{role}.0123456789" for role in ROLES}
OPERATIONS = [operation for group in json.loads((ROOT / "protocol" / "spec" / "operations.json").read_text())["groups"]
              for operation in group["operations"]]


class Access(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.file = self.folder / "tokens.json"

    def write(self, **more):
        tokens = [{"role": role, "token": token} for role, token in TOKENS.items()]
        self.file.write_text(json.dumps({"tokens": tokens, **more}))

    def start(self, *arguments, **more):
        self.write(**more)
        return self.enterContext(Server(SCENES / "hung.json", "--tokens", self.file, *arguments))

    def enterContext(self, context):
        value = context.__enter__()
        self.addCleanup(context.__exit__, None, None, None)
        return value

    async def connect(self, server, token=None):
        client = await weft.connect(server.url(), token=token, timeout=GENEROUS)
        self.addAsyncCleanup(client.close)
        return client

    async def test_each_role_may_give_its_commands_and_no_others(self):
        server = self.start()
        for role, token in TOKENS.items():
            for operation in OPERATIONS:
                with self.subTest(role=role, op=operation["op"]):
                    client = await self.connect(server, token)
                    self.assertEqual(client.welcome["role"], role)
                    message = {name: value for name, value in operation["examples"][0].items() if name not in ("op", "id")}
                    code, path = None, None
                    try:
                        await client.send(operation["op"], **message)
                    except weft.WeftError as error:
                        code, path = error.code, error.path
                    if ROLES.index(role) < ROLES.index(operation["role"]):
                        self.assertEqual((code, path), ("forbidden", "/op"))
                    else:
                        self.assertNotEqual(code, "forbidden")
                    await client.close()

    async def test_what_is_forbidden_has_no_effect_and_says_what_is_needed(self):
        server = self.start()
        client = await self.connect(server, TOKENS["view"])
        with self.assertRaisesRegex(weft.WeftError, "role is view; allowed: control and above"):
            await client.pause()
        frame = await client.next_frame()
        later = await client.next_frame(lambda each: each.stamp.f > frame.stamp.f + 5)
        self.assertGreater(later.stamp.time, frame.stamp.time)

    def test_a_token_may_be_shown_in_three_ways(self):
        server = self.start()
        token = TOKENS["view"]
        for place, arguments in {
                "header": {"Authorization": f"Bearer {token}"},
                "header, scheme in lower case": {"Authorization": f"bearer {token}"},
                "subprotocol": {"Sec_WebSocket_Protocol": f"weft.v1, weft.token.{token}"},
                "subprotocol on a line of its own": {"Sec_WebSocket_Protocol": ["weft.v1", f"weft.token.{token}"]},
                "query": {"target": f"/v1/scenes/hung?token={token}"},
                "query among others": {"target": f"/v1/scenes/hung?a=b&token={token}&c"},
                "twice the same": {"target": f"/v1/scenes/hung?token={token}", "Authorization": f"Bearer {token}"}}.items():
            with self.subTest(place):
                self.assertEqual(server.upgrade(**{"target": "/v1/scenes/hung", **arguments}), 101)

    def test_others_are_refused(self):
        server = self.start()
        known, other = TOKENS["admin"], "x" * 32
        for name, status, arguments in [
                ("none", 401, {}),
                ("unknown", 401, {"Authorization": f"Bearer {other}"}),
                ("cut", 401, {"Authorization": f"Bearer {known[:-1]}"}),
                ("longer", 401, {"Authorization": f"Bearer {known}x"}),
                ("its hash", 401, {"Authorization": f"Bearer {hashlib.sha256(known.encode()).hexdigest()}"}),
                ("too short", 400, {"Authorization": "Bearer short"}),
                ("empty", 400, {"target": "/v1/scenes/hung?token="}),
                ("another scheme", 400, {"Authorization": f"Basic {known}"}),
                ("two headers", 400, {"Authorization": [f"Bearer {known}", f"Bearer {known}"]}),
                ("two that differ", 400, {"target": f"/v1/scenes/hung?token={other}", "Authorization": f"Bearer {known}"}),
                ("a name of no token", 400, {"Sec_WebSocket_Protocol": "weft.v1, weft.token."})]:
            with self.subTest(name):
                self.assertEqual(server.upgrade(**{"target": "/v1/scenes/hung", **arguments}), status)
        status, headers, body = server.get("/v1/scenes")
        self.assertEqual((status, headers["www-authenticate"]), (401, 'Bearer realm="weft"'))
        self.assertIn(b"Authorization: Bearer", body)
        self.assertFalse([line for line in server.log_lines if known in line or other in line])

    def test_the_page_and_the_health_check_are_open_and_lists_are_not(self):
        with page_directory() as page:
            server = self.start("--web", page)
            for target, status in [("/", 200), ("/main.js", 200), ("/healthz", 200), ("/v1/scenes", 401),
                                   ("/v1/scenes/", 401), ("/v1/scenes/hung/meshes/0", 401), ("/v1/scenes/none", 401)]:
                with self.subTest(target):
                    self.assertEqual(server.get(target)[0], status)
            self.assertEqual(server.get("/v1/scenes", Authorization=f"Bearer {TOKENS['view']}")[0], 200)

    def test_a_page_from_elsewhere_may_show_a_token_where_it_may_connect(self):
        server = self.start("--allow-origin", "https://app.example")
        for origin, allowed in [("https://app.example", True), ("https://evil.example", False)]:
            with self.subTest(origin):
                status, headers, _ = server.get("/v1/scenes", method="OPTIONS", Origin=origin)
                self.assertEqual(status, 204)
                self.assertEqual(headers.get("access-control-allow-origin"), origin if allowed else None)
                self.assertEqual(headers.get("access-control-allow-headers"), "Authorization, Content-Type" if allowed else None)
                self.assertEqual(headers.get("access-control-allow-methods"), "GET, PUT, DELETE" if allowed else None)

    async def test_who_shows_none_may_have_a_role(self):
        server = self.start(without_token="view")
        self.assertEqual((await self.connect(server)).welcome["role"], "view")
        self.assertEqual((await self.connect(server, TOKENS["control"])).welcome["role"], "control")
        self.assertEqual(server.upgrade("/v1/scenes/hung", Authorization="Bearer " + "x" * 32), 401)

    async def test_a_file_may_hold_hashes_alone(self):
        digest = hashlib.sha256(TOKENS["control"].encode()).hexdigest().upper()
        self.file.write_text(json.dumps({"tokens": [{"role": "control", "sha256": digest, "name": "script"}]}))
        server = self.enterContext(Server(SCENES / "hung.json", "--tokens", self.file))
        self.assertEqual((await self.connect(server, TOKENS["control"])).welcome["role"], "control")

    async def test_without_tokens_everybody_is_admin(self):
        server = self.enterContext(Server(SCENES / "hung.json"))
        self.assertEqual((await self.connect(server)).welcome["role"], "admin")
        self.assertEqual((await self.connect(server, "x" * 32)).welcome["role"], "admin")

    async def test_sighup_reads_them_anew_or_keeps_those_of_before(self):
        server = self.start()
        client = await self.connect(server, TOKENS["control"])
        self.file.write_text(json.dumps({"tokens": [{"role": "view", "token": "another-token-0123456789"}]}))
        server.terminate(signal.SIGHUP)
        server.wait_for_log("read anew")
        self.assertEqual(server.upgrade("/v1/scenes/hung", Authorization=f"Bearer {TOKENS['control']}"), 401)
        self.assertEqual(server.upgrade("/v1/scenes/hung", Authorization="Bearer another-token-0123456789"), 101)
        await client.pause()  # who is there stays what it is
        self.file.write_text("{")
        server.terminate(signal.SIGHUP)
        server.wait_for_log("those of before stay")
        self.assertEqual(server.upgrade("/v1/scenes/hung", Authorization="Bearer another-token-0123456789"), 101)

    async def refusal(self, *arguments):
        process = await asyncio.create_subprocess_exec(
            BINARY, "serve", str(SCENES / "hung.json"), "--port", "0", *map(str, arguments),
            stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE)
        try:
            _, told = await asyncio.wait_for(process.communicate(), GENEROUS)
        finally:
            with contextlib.suppress(ProcessLookupError):
                process.kill()
        self.assertIn(process.returncode, (1, 2))
        return told.decode()

    async def test_a_bad_file_is_refused_by_name_and_member_and_without_its_secrets(self):
        secret = "secret-secret-secret"
        entry = {"role": "view", "token": secret}
        for document, words in [
                ("[]", "the document must be an object of tokens, without_token"),
                ("{", "not JSON"),
                (json.dumps({"tokens": []}), "/tokens must be an array of 1..1024 tokens"),
                (json.dumps({"token": [entry]}), "/token is unknown; allowed: tokens, without_token"),
                (json.dumps({"tokens": [entry], "without_token": "guest"}), '/without_token is "guest"; allowed: "view"'),
                (json.dumps({"tokens": [{"token": secret}]}), "/tokens/0/role is missing"),
                (json.dumps({"tokens": [{**entry, "role": "root"}]}), '/tokens/0/role is "root"; allowed: "view"'),
                (json.dumps({"tokens": [{**entry, "sha256": "0" * 64}]}), "/tokens/0 must have exactly one of token and sha256"),
                (json.dumps({"tokens": [{**entry, "age": 1}]}), "/tokens/0/age is unknown"),
                (json.dumps({"tokens": [{**entry, "token": "short"}]}), "/tokens/0/token must be 16..128 letters"),
                (json.dumps({"tokens": [{**entry, "token": secret + "!"}]}), "/tokens/0/token must be 16..128 letters"),
                (json.dumps({"tokens": [{"role": "view", "sha256": "0" * 63 + "g"}]}), "/tokens/0/sha256 must be 64 hexadecimal"),
                (json.dumps({"tokens": [entry, {**entry, "role": "admin"}]}), "/tokens/1 is a token that stands there already")]:
            with self.subTest(words):
                self.file.write_text(document)
                told = await self.refusal("--tokens", self.file)
                self.assertIn(words, told)
                self.assertIn(str(self.file), told)
                self.assertNotIn(secret, told)

    async def test_an_address_that_others_reach_needs_tokens_or_a_word(self):
        told = await self.refusal("--host", "0.0.0.0")
        self.assertIn("give --tokens, or --insecure", told)
        self.write()
        for arguments in [("--insecure",), ("--tokens", self.file)]:
            with self.subTest(arguments):
                server = self.enterContext(Server(SCENES / "hung.json", "--host", "0.0.0.0", *arguments))
                with socket.create_connection(("127.0.0.1", server.port), GENEROUS):
                    pass


if __name__ == "__main__":
    unittest.main()
