"""The Debian package: what is in it runs, is found where it says, and is what systemd takes."""
import os
import pathlib
import re
import select
import shutil
import subprocess
import tempfile
import unittest
import urllib.request

BUILD = pathlib.Path(os.environ["WEFT_BUILD"])
LIMIT_S = 120


def output(*command):
    done = subprocess.run([str(each) for each in command], capture_output=True, text=True, timeout=LIMIT_S)
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.stdout}{done.stderr}")
    return done.stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        output("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", folder.name)
        cls.deb, = pathlib.Path(folder.name).glob("weft_*.deb")
        cls.root = pathlib.Path(folder.name) / "root"
        output("dpkg-deb", "-x", cls.deb, cls.root)

    def test_tells_its_dependencies_and_its_configuration(self):
        fields = output("dpkg-deb", "-f", self.deb)
        for library in ("libssl3", "libfcl0.7", "libprometheus-cpp-core1.0", "libspdlog1.10"):
            self.assertIn(library, fields)
        self.assertEqual(output("dpkg-deb", "-I", self.deb, "conffiles"), "/etc/weft/weft.toml\n")
        outside = [str(path.relative_to(self.root)) for path in self.root.glob("*") if path.name not in ("usr", "etc", "lib")]
        self.assertEqual(outside, [])

    def test_the_program_serves_the_page_with_the_configuration_that_comes_with_it(self):
        weft, configuration = self.root / "usr" / "bin" / "weft", self.root / "etc" / "weft" / "weft.toml"
        self.assertEqual(output(weft, "config", "check", "--config", configuration), "ok\n")
        server = subprocess.Popen([weft, "serve", "--config", configuration, "--port", "0", "--quiet"], stdout=subprocess.PIPE, text=True)
        try:
            self.assertTrue(select.select([server.stdout], [], [], LIMIT_S)[0])
            address = re.search(r"http://\S+", server.stdout.readline())[0]
            with urllib.request.urlopen(address, timeout=LIMIT_S) as page:
                self.assertIn(b"<title>", page.read())
        finally:
            server.terminate()
            server.wait(LIMIT_S)
            server.stdout.close()

    @unittest.skipUnless(shutil.which("systemd-analyze"), "no systemd here")
    def test_systemd_takes_the_unit(self):
        unit = self.root.parent / "weft.service"
        text = (self.root / "lib" / "systemd" / "system" / "weft.service").read_text()
        unit.write_text(text.replace("/usr/bin/weft", str(self.root / "usr" / "bin" / "weft")))
        done = subprocess.run(["systemd-analyze", "verify", "--man=no", str(unit)], capture_output=True, text=True, timeout=LIMIT_S)
        self.assertEqual([line for line in done.stderr.splitlines() if "weft.service" in line], [])


if __name__ == "__main__":
    unittest.main()
