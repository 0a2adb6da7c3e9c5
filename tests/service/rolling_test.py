"""Three servers behind HAProxy, as docker/ has it, are restarted in turns: viewers are told, by 1001, and come back to the others."""
import asyncio
import contextlib
import json
import pathlib
import shutil
import signal
import ssl
import subprocess
import tempfile
import time
import unittest

from proxies_test import ENVIRONMENT, adapted, free_port
from serving import GENEROUS, SCENES, Server
from tls_test import make_certificate

import weft
import websockets

NODES, VIEWERS = 3, 12
NAMES = ["hung", "still", "falling", "everything"]
CHECKED = 1  # s, between HAProxy's questions whether a server is there


@unittest.skipUnless(shutil.which("haproxy", path=ENVIRONMENT["PATH"]), "haproxy is not installed")
class Rolling(unittest.IsolatedAsyncioTestCase):
    async def test_viewers_come_back_while_each_server_is_restarted(self):
        with contextlib.ExitStack() as stack:
            folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
            nodes = [self.start() for _ in range(NODES)]
            stack.callback(lambda: [node.end() for node in nodes])
            self.start_proxy(stack, folder, nodes)
            await self.until(self.joins)
            viewers = [await weft.connect(self.url(NAMES[i % len(NAMES)]), tls=self.trust, timeout=GENEROUS, reconnect=True)
                       for i in range(VIEWERS)]
            moved, self.told = 0, 0
            for i, node in enumerate(nodes):
                moved += await self.restart(nodes, i, viewers)
                await asyncio.sleep(3 * CHECKED)  # until HAProxy knows that it is there again
            for viewer in viewers:  # before what they would come back to is gone
                await viewer.close()
            self.assertGreaterEqual(moved, VIEWERS)  # each viewer's server was restarted at least once
            self.assertGreater(self.told, 0)

    def start(self, port=0):
        return Server(*[SCENES / f"{name}.json" for name in NAMES], "--connections-per-address", 0, port=port)

    def start_proxy(self, stack, folder, nodes):
        certificate, key = make_certificate(folder, "proxy")
        (folder / "both.pem").write_bytes(certificate.read_bytes() + key.read_bytes())
        self.trust, self.port = ssl.create_default_context(cafile=str(certificate)), free_port()
        one = "server weft 127.0.0.1:8080 "
        text = adapted("haproxy.cfg", {"bind :443": f"bind 127.0.0.1:{self.port}", "/etc/haproxy/weft.pem": folder / "both.pem"})
        line = next(each for each in text.splitlines() if one in each)
        lines = [line.replace(one, f"server weft{i} 127.0.0.1:{node.port} ") for i, node in enumerate(nodes)]
        (folder / "haproxy.cfg").write_text(text.replace(line, "\n".join(lines)))
        log = stack.enter_context(open(folder / "log", "w"))
        process = subprocess.Popen(["haproxy", "-db", "-f", "haproxy.cfg"], cwd=folder, env=ENVIRONMENT, stdout=log, stderr=subprocess.STDOUT)
        stack.callback(process.wait)
        stack.callback(process.terminate)

    def url(self, scene):
        return f"wss://localhost:{self.port}/cloth/v1/scenes/{scene}"

    async def joins(self):
        with contextlib.suppress(weft.WeftError):
            async with await weft.connect(self.url("hung"), tls=self.trust, timeout=GENEROUS):
                return True
        return False

    async def until(self, condition):
        end = time.monotonic() + GENEROUS
        while not (await result if asyncio.iscoroutine(result := condition()) else result):
            self.assertLess(time.monotonic(), end, "never true")
            await asyncio.sleep(0.05)

    async def restart(self, nodes, which, viewers):
        """One server; gives how many of `viewers` were on it."""
        node, before = nodes[which], [viewer.welcome["instance"] for viewer in viewers]
        async with await weft.connect(node.url("hung"), timeout=GENEROUS) as direct:
            here = direct.welcome["instance"]
        moved = [viewer for viewer, instance in zip(viewers, before) if instance == here]
        # Clients that do not come back see the close. Not all are here: a server that is there again is given its scenes' newcomers.
        bare = []
        for name in NAMES:
            connection = await websockets.connect(self.url(name), subprotocols=["weft.v1"], compression=None, ssl=self.trust)
            if json.loads(await connection.recv())["instance"] == here:
                bare.append(connection)
            else:
                await connection.close()
        start = time.monotonic()
        node.terminate(signal.SIGTERM)
        for viewer in moved:
            await self.until(lambda viewer=viewer: viewer.welcome.get("instance", here) != here)
            await viewer.next_frame(timeout=GENEROUS)
        print(f"server {which}: {len(moved)} viewers back after {time.monotonic() - start:.2f} s")
        self.told += len(bare)
        for connection in bare:
            with self.assertRaises(websockets.ConnectionClosed):
                while True:
                    await asyncio.wait_for(connection.recv(), GENEROUS)
            self.assertEqual(connection.close_code, 1001)  # the server's own word, by way of HAProxy
        self.assertEqual(node.process.wait(GENEROUS), 0)
        node.end()
        nodes[which] = self.start(node.port)
        # Those on other servers have seen nothing of it.
        self.assertEqual([viewer.welcome["instance"] for viewer in viewers if viewer not in moved],
                         [instance for instance in before if instance != here])
        return len(moved)


if __name__ == "__main__":
    unittest.main()
