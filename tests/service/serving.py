"""Starts the real `weft serve` for a test, and speaks raw HTTP to it. The executable is named by WEFT_BINARY."""
import contextlib
import os
import pathlib
import re
import select
import signal
import socket
import subprocess
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SCENES = HERE / "scenes"
sys.path.insert(0, str(ROOT / "protocol" / "clients" / "python"))

BINARY = os.environ["WEFT_BINARY"]
SANITIZED = bool(os.environ.get("WEFT_SANITIZE"))
GENEROUS = 30  # s, for what takes milliseconds


def head_of(method, target, fields):
    """The head of a request; a value None leaves a header out, a list gives it a line each."""
    lines = [f"{method} {target} HTTP/1.1"]
    for name, value in fields.items():
        values = value if isinstance(value, list) else [] if value is None else [value]
        lines += [f"{name.replace('_', '-')}: {each}" for each in values]
    return ("\r\n".join(lines) + "\r\n\r\n").encode()


class Server:
    """`weft serve`, or another `command` that serves, on a free port, ended when the test is."""

    def __init__(self, *arguments, port=0, command="serve"):
        self.log_lines = []
        self._log_grew = threading.Condition()
        self.process = subprocess.Popen([BINARY, command, "--port", str(port), *map(str, arguments)],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self._log_reader = threading.Thread(target=self._read_log, daemon=True)
        self._log_reader.start()
        ready, _, _ = select.select([self.process.stdout], [], [], GENEROUS)
        line = self.process.stdout.readline() if ready else ""
        match = re.fullmatch(r"Weft is at https?://127\.0\.0\.1:(\d+)/\n", line)
        if not match:
            self.end()
            raise AssertionError(f"no address but {line!r}; log: {self.log_lines}")
        self.port = int(match.group(1))

    def _read_log(self):
        for line in self.process.stderr:
            with self._log_grew:
                self.log_lines.append(line.rstrip("\n"))
                self._log_grew.notify_all()

    def wait_for_log(self, words):
        """The first log line with these words, waiting for it."""
        def found():
            return next((line for line in self.log_lines if words in line), None)
        with self._log_grew:
            if not self._log_grew.wait_for(found, GENEROUS):
                raise AssertionError(f"no log line with {words!r} in {self.log_lines}")
            return found()

    def url(self, scene="hung"):
        return f"ws://127.0.0.1:{self.port}/v1/scenes/{scene}"

    def memory_kib(self):
        """Resident memory of the server."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+) kB", status).group(1))

    def request(self, text):
        """Sends raw bytes on a connection of its own and gives everything that comes until the server closes."""
        with socket.create_connection(("127.0.0.1", self.port), GENEROUS) as connection:
            connection.sendall(text if isinstance(text, bytes) else text.encode())
            received = b""
            with contextlib.suppress(ConnectionResetError):
                while chunk := connection.recv(65536):
                    received += chunk
            return received

    def get(self, target, *, method="GET", **headers):
        """Status, headers (names in lower case) and body of one request."""
        fields = {"Host": f"127.0.0.1:{self.port}", "Connection": "close", **headers}
        head, _, body = self.request(head_of(method, target, fields)).partition(b"\r\n\r\n")
        status, *fields = head.decode().split("\r\n")
        return int(status.split()[1]), {k.lower(): v for k, _, v in (f.partition(": ") for f in fields)}, body

    def raw_socket(self, target="/v1/scenes/hung", receive_buffer=None, **headers):
        """A socket on which an upgrade has been asked for, and the status of the answer. What follows is for the test to read."""
        fields = {"Host": f"127.0.0.1:{self.port}", "Connection": "Upgrade", "Upgrade": "websocket",
                  "Sec_WebSocket_Version": "13", "Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ==",
                  "Sec_WebSocket_Protocol": "weft.v1", **headers}
        connection = socket.socket()
        connection.settimeout(GENEROUS)
        if receive_buffer:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        connection.connect(("127.0.0.1", self.port))
        connection.sendall(head_of("GET", target, fields))
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += connection.recv(1)
        return connection, int(head.split()[1])

    def upgrade(self, target, **headers):
        """The status of an attempt to open a WebSocket there."""
        connection, status = self.raw_socket(target, **headers)
        connection.close()
        return status

    def terminate(self, number=signal.SIGTERM):
        self.process.send_signal(number)

    def end(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self._log_reader.join()
        self.process.stdout.close()
        self.process.stderr.close()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.end()


def client_frame(opcode, payload=b"", final=True):
    """A WebSocket frame as a client sends it, with a mask of zeros. Payloads of less than 126 bytes."""
    return bytes([(0x80 if final else 0) | opcode, 0x80 | len(payload)]) + b"\0\0\0\0" + payload


def server_frames(connection, received=b""):
    """Opcode and payload of each frame that has come and comes, until the server closes."""
    with contextlib.suppress(ConnectionResetError):
        while chunk := connection.recv(65536):
            received += chunk
    at = 0
    while at < len(received):
        opcode, length, at = received[at] & 0x0f, received[at + 1], at + 2
        if length >= 126:
            size = 2 if length == 126 else 8
            length, at = int.from_bytes(received[at:at + size], "big"), at + size
        yield opcode, received[at:at + length]
        at += length


@contextlib.contextmanager
def page_directory():
    """A directory with a small page in it."""
    with tempfile.TemporaryDirectory() as directory:
        page = pathlib.Path(directory) / "web"
        page.mkdir()
        (page / "index.html").write_text("<!doctype html><title>Page</title>")
        (page / "main.js").write_text("export const answer = 42;")
        (page / "data.json").write_text("{}")
        (page / "code.wasm").write_bytes(b"\0asm")
        (page.parent / "secret.txt").write_text("secret")
        (page / ".hidden").write_text("secret")
        yield page
