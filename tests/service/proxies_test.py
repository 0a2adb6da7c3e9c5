"""Behind HAProxy and nginx, as docker/ has them: TLS, under a path, with tokens. A proxy that is not installed is left out."""
import contextlib
import http.client
import json
import os
import pathlib
import shutil
import socket
import ssl
import subprocess
import tempfile
import time
import unittest

from serving import GENEROUS, ROOT, SCENES, Server, head_of, page_directory
from tls_test import make_certificate

import weft

ADMIN, VIEW = "a-token-of-an-admin-1", "a-token-of-a-viewer-1"
ENVIRONMENT = os.environ | {"PATH": os.environ.get("PATH", "") + ":/usr/sbin"}  # where Debian has them


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as probe:
        return probe.getsockname()[1]


def adapted(name, replacements):
    """An example's text with this machine's addresses and files in place of its own."""
    text = (ROOT / "docker" / name).read_text()
    for old, new in replacements.items():
        if old not in text:
            raise AssertionError(f"docker/{name} has no {old}")
        text = text.replace(old, str(new))
    return text


class BehindAProxy:
    """What holds behind each of them; they are started by `command`."""

    @classmethod
    def setUpClass(cls):
        if not shutil.which(cls.program, path=ENVIRONMENT["PATH"]):
            raise unittest.SkipTest(f"{cls.program} is not installed")
        stack = contextlib.ExitStack()
        cls.addClassCleanup(stack.close)
        cls.folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        cls.certificate, cls.key = make_certificate(cls.folder, "proxy")
        tokens = cls.folder / "tokens.json"
        tokens.write_text(json.dumps({"tokens": [{"role": "admin", "token": ADMIN}, {"role": "view", "token": VIEW}]}))
        page = stack.enter_context(page_directory())
        cls.server = stack.enter_context(Server(SCENES / "hung.json", "--web", page, "--tokens", tokens, "--connections-per-address", 0))
        cls.port = free_port()
        log = stack.enter_context(open(cls.folder / "log", "w"))
        process = subprocess.Popen(cls.command(), cwd=cls.folder, env=ENVIRONMENT, stdout=log, stderr=subprocess.STDOUT)
        stack.callback(process.wait)
        stack.callback(process.terminate)
        end = time.monotonic() + GENEROUS
        while not cls.answers():
            if process.poll() is not None or time.monotonic() > end:
                raise AssertionError(f"{cls.program} does not serve: {(cls.folder / 'log').read_text()}")
            time.sleep(0.05)

    @classmethod
    def answers(cls):
        with contextlib.suppress(OSError):
            return cls.get("/cloth/readyz")[0] == 200
        return False

    @classmethod
    def trust(cls):
        return ssl.create_default_context(cafile=str(cls.certificate))

    @classmethod
    def get(cls, target, **headers):
        """Status, headers and body."""
        connection = http.client.HTTPSConnection("localhost", cls.port, context=cls.trust(), timeout=GENEROUS)
        with contextlib.closing(connection):
            connection.request("GET", target, headers={name.replace("_", "-"): value for name, value in headers.items()})
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()

    def upgrade(self, **headers):
        """The answer's head to an attempt to open a WebSocket."""
        connection, head = self.open(**headers)
        connection.close()
        return head

    def open(self, **headers):
        """A connection on which a WebSocket has been asked for, and the answer's head."""
        fields = {"Host": f"localhost:{self.port}", "Connection": "Upgrade", "Upgrade": "websocket", "Sec_WebSocket_Version": "13",
                  "Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ==", "Sec_WebSocket_Protocol": f"weft.v1, weft.token.{VIEW}", **headers}
        raw = socket.create_connection(("localhost", self.port), GENEROUS)
        connection = self.trust().wrap_socket(raw, server_hostname="localhost")
        connection.sendall(head_of("GET", "/cloth/v1/scenes/hung", fields))
        head = b""
        while not head.endswith(b"\r\n\r\n") and (received := connection.recv(1)):
            head += received
        return connection, head.decode()

    def connect(self, token):
        url = f"wss://localhost:{self.port}/cloth/v1/scenes/hung"
        return weft.connect(url, tls=self.trust(), token=token, timeout=GENEROUS)

    def test_the_page_is_below_the_path_and_nothing_beside_it(self):
        status, _, body = self.get("/cloth/")
        self.assertEqual(status, 200)
        self.assertIn(b"<title>Page</title>", body)
        self.assertEqual(self.get("/cloth/main.js")[0], 200)
        status, headers, _ = self.get("/cloth")
        self.assertEqual((status, headers["Location"]), (308, "/cloth/"))
        self.assertEqual(self.get("/v1/scenes")[0], 404)
        self.assertEqual(self.get("/clothes/")[0], 404)

    def test_lists_and_documents_pass(self):
        self.assertEqual(self.get("/cloth/v1/scenes")[0], 401)
        status, _, body = self.get("/cloth/v1/scenes", Authorization=f"Bearer {VIEW}")
        self.assertEqual((status, json.loads(body)["scenes"][0]["name"]), (200, "hung"))
        self.assertEqual(self.get(f"/cloth/v1/scenes?token={VIEW}")[0], 200)
        document = (SCENES / "still.json").read_bytes()
        connection = http.client.HTTPSConnection("localhost", self.port, context=self.trust(), timeout=GENEROUS)
        with contextlib.closing(connection):
            for method, body, status in (("PUT", document, 201), ("DELETE", None, 204)):
                connection.request(method, "/cloth/v1/scenes/mine", body=body, headers={"Authorization": f"Bearer {ADMIN}"})
                answer = connection.getresponse()
                answer.read()
                self.assertEqual(answer.status, status)

    async def test_frames_flow_and_commands_take_effect(self):
        async with await self.connect(ADMIN) as scene:
            self.assertEqual(scene.welcome["role"], "admin")
            ok = await scene.camera(distance=0.8)
            first = await scene.next_frame(lambda frame: frame.stamp.f >= ok["f"])
            self.assertEqual(first.cloths[0].level, 6)
            await scene.next_frame(lambda frame: frame.stamp.f >= first.stamp.f + 60)
            self.assertLess(await scene.ping(), GENEROUS)

    async def test_tokens_pass_as_header_and_as_subprotocol(self):
        async with await self.connect(VIEW) as scene:
            self.assertEqual(scene.welcome["role"], "view")
        head = self.upgrade()
        self.assertRegex(head, r"^HTTP/1\.1 101 ")
        self.assertRegex(head.lower(), r"sec-websocket-protocol: weft\.v1\r\n")
        self.assertRegex(self.upgrade(Sec_WebSocket_Protocol="weft.v1"), r"^HTTP/1\.1 401 ")
        with self.assertRaises(weft.WeftError):
            await self.connect("a-token-of-nobody-at-all")

    def test_a_page_may_connect_from_where_it_comes_alone(self):
        self.assertRegex(self.upgrade(Host="weft.test:1", Origin="https://weft.test:1"), r"^HTTP/1\.1 421 ")  # no --host-name
        address = f"127.0.0.2:{self.port}"
        self.assertRegex(self.upgrade(Host=address, Origin=f"https://{address}"), r"^HTTP/1\.1 101 ")
        self.assertRegex(self.upgrade(Host=address, Origin="https://elsewhere.example"), r"^HTTP/1\.1 403 ")

    def test_an_address_has_so_many_connections(self):
        with contextlib.ExitStack() as stack:
            heads = []
            for _ in range(140):
                connection, head = self.open()
                stack.callback(connection.close)
                heads.append(head.split()[1])
                if heads[-1] != "101":
                    break
        self.assertEqual(heads[-1], "429")
        self.assertGreater(len(heads), 120)  # of 128, less what has not been forgotten yet

    def test_what_a_client_says_of_its_way_is_not_believed(self):
        """X-Forwarded-* and Forwarded change nothing: neither name, origin, address nor scheme is taken from them."""
        for name in ("X_Forwarded_Host", "Forwarded", "X_Forwarded_For", "X_Forwarded_Proto", "X_Forwarded_Prefix", "X_Real_IP"):
            with self.subTest(name):
                self.assertRegex(self.upgrade(Origin="https://evil.example", Host="127.0.0.2:1", **{name: "evil.example"}), r"^HTTP/1\.1 403 ")
                self.assertEqual(self.get("/cloth/v1/scenes", Authorization=f"Bearer {VIEW}", **{name: "evil.example"})[0], 200)


class Haproxy(BehindAProxy, unittest.IsolatedAsyncioTestCase):
    program = "haproxy"

    @classmethod
    def command(cls):
        both = cls.folder / "both.pem"
        both.write_bytes(cls.certificate.read_bytes() + cls.key.read_bytes())
        (cls.folder / "haproxy.cfg").write_text(adapted("haproxy.cfg", {
            "bind :443": f"bind 127.0.0.1:{cls.port}", "/etc/haproxy/weft.pem": both, "127.0.0.1:8080": f"127.0.0.1:{cls.server.port}"}))
        return ["haproxy", "-db", "-f", "haproxy.cfg"]


class Nginx(BehindAProxy, unittest.IsolatedAsyncioTestCase):
    program = "nginx"

    @classmethod
    def command(cls):
        text = adapted("nginx.conf", {
            "listen 443 ssl": f"listen 127.0.0.1:{cls.port} ssl", "server_name weft.example": "server_name localhost",
            "/etc/nginx/weft.pem": cls.certificate, "/etc/nginx/weft.key": cls.key,
            "http://127.0.0.1:8080/": f"http://127.0.0.1:{cls.server.port}/", "/var/log/nginx/weft.log": cls.folder / "access.log"})
        # Nothing outside of the folder, and this user's.
        places = "".join(f"  {each}_temp_path {cls.folder}/{each};\n" for each in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
        (cls.folder / "nginx.conf").write_text("daemon off;\nmaster_process off;\n" + text.replace("http {\n", "http {\n" + places, 1))
        return ["nginx", "-p", cls.folder, "-c", cls.folder / "nginx.conf", "-e", cls.folder / "errors.log",
                "-g", f"pid {cls.folder}/nginx.pid;"]

    def test_tokens_are_not_logged(self):
        self.get(f"/cloth/v1/scenes?token={VIEW}")
        log = (self.folder / "access.log").read_text()
        self.assertIn("GET /cloth/v1/scenes", log)
        self.assertNotIn(VIEW, log)


if __name__ == "__main__":
    unittest.main()
