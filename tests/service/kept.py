"""A server whose data and recordings are in a folder of the test's own, and what the tests of them share."""
import pathlib
import subprocess
import tempfile
import unittest

from serving import BINARY, GENEROUS, SCENES, Server

import weft

SCENE = SCENES / "hung.json"


def replay(file, *arguments):
    return subprocess.run([BINARY, "replay", str(file), *arguments], capture_output=True, text=True, timeout=300)


class Kept(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.data = self.folder / "data"

    def start(self, *arguments, scene=SCENE):
        server = Server(scene, *arguments)
        self.addCleanup(server.end)
        return server

    async def join(self, server, scene="hung"):
        client = await weft.connect(server.url(scene), timeout=GENEROUS)
        self.addAsyncCleanup(client.close)
        await client.camera(distance=20)
        return client
