"""The server's HTTP side: page, list, health, and everything it refuses."""
import contextlib
import json
import socket
import threading
import unittest

from serving import GENEROUS, SCENES, Server, page_directory


class Http(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = cls.enterClassContext(page_directory())
        cls.server = cls.enterClassContext(
            Server(SCENES / "hung.json", SCENES / "still.json", "--web", cls.page, "--allow-origin", "https://show.example",
                   "--host-name", "weft.example", "--host-name", "other.example"))

    @classmethod
    def enterClassContext(cls, manager):  # of unittest from Python 3.11 on
        result = manager.__enter__()
        cls.addClassCleanup(manager.__exit__, None, None, None)
        return result

    def test_health(self):
        status, headers, body = self.server.get("/healthz")
        self.assertEqual((status, body), (200, b"ok"))
        self.assertEqual(headers["cache-control"], "no-store")

    def test_list_of_scenes(self):
        status, headers, body = self.server.get("/v1/scenes")
        self.assertEqual(status, 200)
        self.assertEqual(headers["content-type"], "application/json")
        self.assertEqual(json.loads(body)["scenes"], [
            {"name": "hung", "title": "A soft cloth in wind, with Table 1's thresholds", "viewers": 0, "cloths": 1},
            {"name": "still", "title": "A small cloth without wind", "viewers": 0, "cloths": 1}])

    def test_page_and_its_files(self):
        for target, media_type, content in [("/", "text/html; charset=utf-8", b"<!doctype html><title>Page</title>"),
                                            ("/?scene=hung", "text/html; charset=utf-8", b"<!doctype html><title>Page</title>"),
                                            ("/main.js", "text/javascript; charset=utf-8", b"export const answer = 42;"),
                                            ("/data.json", "application/json", b"{}"),
                                            ("/code.wasm", "application/wasm", b"\0asm")]:
            with self.subTest(target):
                status, headers, body = self.server.get(target)
                self.assertEqual((status, body), (200, content))
                self.assertEqual(headers["content-type"], media_type)
                self.assertEqual(headers["x-content-type-options"], "nosniff")
                self.assertIn("default-src 'self'", headers["content-security-policy"])

    def test_unchanged_files_are_not_sent_again(self):
        _, headers, _ = self.server.get("/main.js")
        status, again, body = self.server.get("/main.js", If_None_Match=headers["etag"])
        self.assertEqual((status, body), (304, b""))
        self.assertEqual(again["etag"], headers["etag"])
        self.assertEqual(self.server.get("/main.js", If_None_Match='"other"')[0], 200)

    def test_head_has_the_headers_alone(self):
        status, headers, body = self.server.get("/main.js", method="HEAD")
        self.assertEqual((status, body), (200, b""))
        self.assertEqual(headers["content-length"], "25")

    def test_paths_out_of_the_page_are_not_found(self):
        for target in ["/../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt", "/sub/../../secret.txt", "/.hidden",
                       "//etc/passwd", "/main.js%00.html", "/none.js", "/v1", "/v1/scenes/none", "/v1/scenes/../healthz"]:
            with self.subTest(target):
                status, _, body = self.server.get(target)
                self.assertEqual(status, 404)
                self.assertNotIn(b"secret", body)

    def test_other_methods_are_not_allowed(self):
        for method in ["POST", "PUT", "DELETE", "OPTIONS", "TRACE", "PATCH"]:
            with self.subTest(method):
                status, headers, _ = self.server.get("/", method=method)
                self.assertEqual(status, 405)
                self.assertEqual(headers["allow"], "GET, HEAD")

    def test_a_request_with_a_body_is_answered_and_ended(self):
        received = self.server.request("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000\r\n\r\nabc")
        self.assertTrue(received.startswith(b"HTTP/1.1 405 "), received[:60])

    def test_what_is_no_request_is_400(self):
        for text in ["hello\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "GET /\r\n\r\n", "\x16\x03\x01\x02\x00\x01\r\n\r\n"]:
            with self.subTest(text):
                self.assertTrue(self.server.request(text).startswith(b"HTTP/1.1 400 "))

    def test_a_header_beyond_8_kib_is_431(self):
        received = self.server.request("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + "a" * 9000 + "\r\n\r\n")
        self.assertTrue(received.startswith(b"HTTP/1.1 431 "), received[:60])

    def test_only_names_of_its_own_are_answered(self):
        # A page of evil.example whose name is made to resolve to this machine is of the same origin as what it asks for.
        for target in ["/", "/healthz", "/v1/scenes", "/none"]:
            for host in ["evil.example", f"evil.example:{self.server.port}", "localhost.evil.example", ""]:
                with self.subTest(target, host=host):
                    status, _, body = self.server.get(target, Host=host, Origin=f"http://{host}")
                    self.assertEqual(status, 421)
                    self.assertIn(b"--host-name", body)
        for host in ["localhost", "127.0.0.1", "[::1]:8080", "192.168.0.7", "weft.example:443", "OTHER.example"]:
            with self.subTest(host):
                self.assertEqual(self.server.get("/healthz", Host=host)[0], 200)

    def test_headers_that_must_stand_once_are_400(self):
        for name in ["Host", "Origin"]:
            with self.subTest(name):
                status, _, body = self.server.get("/", **{name: ["http://localhost", "http://localhost"]})
                self.assertEqual(status, 400)
                self.assertIn(name.encode(), body)
        for host in [None, "a b", "localhost/", "x@localhost", "localhost, localhost"]:
            with self.subTest(host):
                self.assertEqual(self.server.get("/", Host=host)[0], 400)

    def test_several_requests_on_one_connection(self):
        received = self.server.request("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n" * 2 +
                                       "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
        self.assertEqual(received.count(b"HTTP/1.1 200 OK"), 3)

    def test_one_that_never_ends_its_header_is_cut(self):
        with socket.create_connection(("127.0.0.1", self.server.port), GENEROUS) as slow:
            slow.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\nX: ")
            self.assertEqual(slow.recv(1), b"")  # after the server's 5 s

    def test_each_byte_of_a_header_buys_no_more_time(self):
        with socket.create_connection(("127.0.0.1", self.server.port), GENEROUS) as slow:
            slow.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\nX: ")
            sent, ended = 0, threading.Event()

            def dribble():
                nonlocal sent
                with contextlib.suppress(OSError):
                    while not ended.wait(0.25):
                        slow.sendall(b"x")
                        sent += 1
            writer = threading.Thread(target=dribble)
            writer.start()
            with contextlib.suppress(ConnectionResetError):
                self.assertEqual(slow.recv(1), b"")
            ended.set()
            writer.join()
        # 20 fit into the server's 5 s; were the time to begin anew with each, the server would never close.
        self.assertLessEqual(sent, 30)

    # --- The upgrade to a WebSocket ---

    def test_upgrade(self):
        self.assertEqual(self.server.upgrade("/v1/scenes/hung"), 101)
        self.assertEqual(self.server.upgrade("/v1/scenes/hung?x=1", Sec_WebSocket_Protocol="other, weft.v1"), 101)

    def test_lists_may_stand_on_several_lines(self):  # RFC 9110, section 5.3
        for header, lines in [("Sec_WebSocket_Protocol", ["other", "weft.v1"]), ("Connection", ["keep-alive", "Upgrade"]),
                              ("Upgrade", ["other", "websocket"])]:
            with self.subTest(header):
                self.assertEqual(self.server.upgrade("/v1/scenes/hung", **{header: lines}), 101)

    def test_upgrade_without_the_subprotocol_is_400(self):
        # Its case matters: RFC 6455, section 4.1.
        for offered in [None, "", "weft.v2", "WEFT.V1", "Weft.v1", "weft.v1.x", ["other", "weft.v2"]]:
            with self.subTest(offered):
                self.assertEqual(self.server.upgrade("/v1/scenes/hung", Sec_WebSocket_Protocol=offered), 400)

    def test_upgrade_without_a_key_of_16_bytes_is_400(self):  # RFC 6455, section 4.2.1
        good = "dGhlIHNhbXBsZSBub25jZQ=="
        for key in [None, "", "x", good[:-1], good[:-2], good + "=", good[:-4] + "====", "A" + good, good[:-6] + "==",
                    "!" + good[1:], good[:-3] + "R==", "dGhlIHNhbXBsZSBub25jZSEh", [good, good], [good, "AAAAAAAAAAAAAAAAAAAAAA=="]]:
            with self.subTest(key):
                self.assertEqual(self.server.upgrade("/v1/scenes/hung", Sec_WebSocket_Key=key), 400)

    def test_upgrade_of_another_version_is_426(self):
        for version in [None, "8", "130"]:
            with self.subTest(version):
                status, headers, _ = self.server.get(
                    "/v1/scenes/hung", Connection="Upgrade", Upgrade="websocket", Sec_WebSocket_Version=version,
                    Sec_WebSocket_Key="dGhlIHNhbXBsZSBub25jZQ==", Sec_WebSocket_Protocol="weft.v1")
                self.assertEqual((status, headers["sec-websocket-version"]), (426, "13"))
        self.assertEqual(self.server.upgrade("/v1/scenes/hung", Sec_WebSocket_Version=["13", "13"]), 400)

    def test_upgrade_under_a_foreign_name_is_421(self):
        for host in ["evil.example", f"evil.example:{self.server.port}"]:
            self.assertEqual(self.server.upgrade("/v1/scenes/hung", Host=host, Origin=f"http://{host}"), 421)
            self.assertEqual(self.server.upgrade("/v1/scenes/hung", Host=host), 421)

    def test_upgrade_of_an_unknown_scene_is_404(self):
        self.assertEqual(self.server.upgrade("/v1/scenes/none"), 404)
        self.assertEqual(self.server.upgrade("/v1/scenes/"), 200)  # the list, which is no WebSocket

    def test_a_scene_without_upgrade_is_426(self):
        status, headers, _ = self.server.get("/v1/scenes/hung")
        self.assertEqual(status, 426)
        self.assertEqual(headers["upgrade"], "websocket")

    def test_upgrade_from_foreign_pages_is_403(self):
        for origin in ["https://evil.example", "null", f"http://127.0.0.1.evil.example:{self.server.port}",
                       "https://show.example.evil.example", "http://show.example"]:
            with self.subTest(origin):
                self.assertEqual(self.server.upgrade("/v1/scenes/hung", Origin=origin), 403)

    def test_upgrade_from_allowed_pages(self):
        for origin in ["http://localhost:3000", f"http://127.0.0.1:{self.server.port}", "https://show.example"]:
            with self.subTest(origin):
                self.assertEqual(self.server.upgrade("/v1/scenes/hung", Origin=origin), 101)
        self.assertEqual(self.server.upgrade("/v1/scenes/hung", Host="weft.example", Origin="https://weft.example"), 101)

    def test_the_list_may_be_read_by_allowed_pages_alone(self):
        _, headers, _ = self.server.get("/v1/scenes", Origin="https://show.example")
        self.assertEqual(headers["access-control-allow-origin"], "https://show.example")
        _, headers, _ = self.server.get("/v1/scenes", Origin="https://evil.example")
        self.assertNotIn("access-control-allow-origin", headers)


if __name__ == "__main__":
    unittest.main()
