"""TLS at the server's one port, beside plain HTTP."""
import contextlib
import pathlib
import signal
import socket
import ssl
import subprocess
import tempfile
import time
import unittest

from serving import BINARY, GENEROUS, SCENES, Server, client_frame, head_of, page_directory, server_frames

import weft


def make_certificate(folder, name):
    """A certificate that signs itself, for localhost and 127.0.0.1, and its key."""
    certificate, key = folder / f"{name}.pem", folder / f"{name}.key"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2",
                    "-subj", f"/CN={name}", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1", "-keyout", key, "-out", certificate],
                   check=True, capture_output=True)
    return certificate, key


class Tls(unittest.IsolatedAsyncioTestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.certificate, cls.key = make_certificate(cls.folder, "one")
        cls.other = make_certificate(cls.folder, "other")

    def start(self, *arguments):
        server = Server(SCENES / "hung.json", "--tls-certificate", self.certificate, "--tls-key", self.key, *arguments)
        self.addCleanup(server.end)
        return server

    def trust(self, certificate=None):
        return ssl.create_default_context(cafile=str(certificate or self.certificate))

    def secure(self, server, context=None):
        raw = socket.create_connection(("127.0.0.1", server.port), GENEROUS)
        self.addCleanup(raw.close)
        return (context or self.trust()).wrap_socket(raw, server_hostname="localhost")

    def get(self, connection, target):
        with connection:
            connection.sendall(head_of("GET", target, {"Host": "localhost", "Connection": "close"}))
            received = b""
            while chunk := connection.recv(65536):
                received += chunk
            return received

    async def test_scenes_are_seen_by_wss_and_by_ws(self):
        server = self.start()
        async with await weft.connect(f"wss://localhost:{server.port}/v1/scenes/hung", tls=self.trust(), timeout=GENEROUS) as secure:
            async with await weft.connect(server.url(), timeout=GENEROUS) as plain:
                await secure.camera(distance=0.5)
                ok = await secure.add_ball([0, 0, 1], 0.2)
                frame = await plain.next_frame(lambda each: len(each.balls) == 1)
                self.assertEqual(frame.balls[0].ball, ok)
                frame = await secure.next_frame(lambda each: each.cloths[0].level == 6)
                self.assertEqual(frame.cloths[0].rows, 65)

    def test_page_and_list_come_by_https(self):
        with page_directory() as page:
            server = self.start("--web", page)
            for target, words in [("/", b"<title>Page</title>"), ("/v1/scenes", b'"hung"'), ("/healthz", b"ok")]:
                answer = self.get(self.secure(server), target)
                self.assertTrue(answer.startswith(b"HTTP/1.1 200 OK"), answer)
                self.assertIn(words, answer)
        # The server says that it has sent all (RFC 8446, 6.1): what was read above did not merely break off.
        connection = self.secure(server)
        connection.suppress_ragged_eofs = False
        self.assertTrue(self.get(connection, "/healthz").endswith(b"ok"))

    def test_others_are_sent_to_https_and_this_machine_is_not(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:  # sends nothing
            with contextlib.suppress(OSError):
                probe.connect(("192.0.2.1", 9))
            address = probe.getsockname()[0]
        if address.startswith(("127.", "0.")):
            self.skipTest("this machine has no address but its own loopback")
        for more, status in [((), 308), (("--insecure",), 401)]:
            self.tokens = self.folder / "tokens.json"
            self.tokens.write_text('{"tokens": [{"role": "view", "token": "a-token-of-a-viewer-1"}]}')
            server = self.start("--host", "0.0.0.0", "--tokens", self.tokens, *more)
            for target, expected in [("/v1/scenes/hung?a=b", status), ("/healthz", 200)]:
                with self.subTest(target, insecure=more), socket.create_connection((address, server.port), GENEROUS) as connection:
                    answer = self.get(connection, target)
                    self.assertIn(f"HTTP/1.1 {expected} ".encode(), answer)
                    self.assertEqual(b"Location: https://localhost/v1/scenes/hung?a=b\r\n" in answer, expected == 308)
            self.assertEqual(server.get("/v1/scenes")[0], 401)  # from here: plain, and a token is in want

    def test_old_versions_are_refused(self):
        server = self.start()
        for version in (ssl.TLSVersion.TLSv1_2, ssl.TLSVersion.TLSv1_3):
            context = self.trust()
            context.minimum_version = context.maximum_version = version
            self.assertIn(b"200 OK", self.get(self.secure(server, context), "/healthz"))
        old = subprocess.run(["openssl", "s_client", "-connect", f"127.0.0.1:{server.port}", "-tls1_1", "-cipher", "ALL:@SECLEVEL=0"],
                             input=b"", capture_output=True, timeout=GENEROUS)
        self.assertNotEqual(old.returncode, 0)
        self.assertIn(b"alert protocol version", old.stderr)  # the server's word, not the client's

    def test_a_close_and_its_reason_arrive(self):
        server = self.start()
        connection = self.secure(server)
        self.addCleanup(connection.close)
        connection.sendall(head_of("GET", "/v1/scenes/hung", {
            "Host": "localhost", "Connection": "Upgrade", "Upgrade": "websocket", "Sec_WebSocket_Version": "13",
            "Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ==", "Sec_WebSocket_Protocol": "weft.v1"}))
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += connection.recv(1)
        self.assertTrue(head.startswith(b"HTTP/1.1 101"))
        connection.sendall(client_frame(0x2, b"binary"))
        codes = [int.from_bytes(payload[:2], "big") for opcode, payload in server_frames(connection) if opcode == 8]
        self.assertEqual(codes, [1003])

    def test_garbage_and_silence_end_and_disturb_nobody(self):
        server = self.start()
        hello = bytes([0x16, 3, 1, 2, 0]) + bytes(range(256)) * 2
        for bytes_sent in (hello, hello[:7], bytes([0x16, 3, 1, 0, 5]) + b"12345", b"\x16\x03"):
            with self.subTest(bytes_sent[:8]), socket.create_connection(("127.0.0.1", server.port), GENEROUS) as connection:
                connection.sendall(bytes_sent)
                self.assertIn(b"200 OK", self.get(self.secure(server), "/healthz"))
                while connection.recv(4096):  # an alert, or nothing: then it is closed, at the latest after 5 s
                    pass

    async def test_sighup_takes_a_new_certificate_and_keeps_who_is_there(self):
        certificate, key = self.folder / "used.pem", self.folder / "used.key"
        certificate.write_bytes(self.certificate.read_bytes())
        key.write_bytes(self.key.read_bytes())
        server = Server(SCENES / "hung.json", "--tls-certificate", certificate, "--tls-key", key)
        self.addCleanup(server.end)
        async with await weft.connect(f"wss://localhost:{server.port}/v1/scenes/hung", tls=self.trust(), timeout=GENEROUS) as client:
            certificate.write_bytes(self.other[0].read_bytes())  # not yet its key
            server.terminate(signal.SIGHUP)
            server.wait_for_log("those of before stay")
            self.assertIn(b"200 OK", self.get(self.secure(server), "/healthz"))
            key.write_bytes(self.other[1].read_bytes())
            server.terminate(signal.SIGHUP)
            server.wait_for_log("read anew")
            self.assertIn(b"200 OK", self.get(self.secure(server, self.trust(self.other[0])), "/healthz"))
            frame = await client.next_frame()
            await client.next_frame(lambda each: each.stamp.f > frame.stamp.f)

    def test_files_that_cannot_be_used_are_named(self):
        key_of_other = self.other[1]
        empty = self.folder / "empty.pem"
        empty.write_text("")
        for certificate, key, named in [(self.certificate, key_of_other, key_of_other), (empty, self.key, empty),
                                        (self.certificate, empty, empty)]:
            with self.subTest(named=named.name):
                done = subprocess.run([BINARY, "serve", SCENES / "hung.json", "--port", "0", "--tls-certificate", certificate,
                                       "--tls-key", key], capture_output=True, text=True, timeout=GENEROUS)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(str(named), done.stderr)

    def test_the_command_line_client_checks_whom_it_talks_to(self):
        server = self.start()

        def client(*arguments):
            return subprocess.run([BINARY, "client", f"https://localhost:{server.port}/", *map(str, arguments)], capture_output=True,
                                  text=True, timeout=GENEROUS)
        self.assertEqual(client("--health", "--ca", self.certificate).stdout, "200 ok\n")
        frames = client("--scene", "hung", "--frames", 3, "--ca", self.certificate)
        self.assertEqual((frames.returncode, frames.stdout.count("frame ")), (0, 3), frames.stderr)
        for arguments in [("--health",), ("--health", "--ca", self.other[0])]:
            refused = client(*arguments)
            self.assertNotEqual(refused.returncode, 0)
            self.assertIn("no TLS with localhost", refused.stderr)

    def test_it_stops_in_time_with_viewers(self):
        server = self.start()
        with self.secure(server) as silent:
            silent.sendall(b"GET")
            server.terminate()
            start = time.monotonic()
            self.assertEqual(server.process.wait(GENEROUS), 0)
            self.assertLess(time.monotonic() - start, 10)


if __name__ == "__main__":
    unittest.main()
