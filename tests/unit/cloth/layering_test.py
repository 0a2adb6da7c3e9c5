"""Holds the order of the folders: cli > net > host > study > scene > cloth, and net, host > protocol; and of those in cloth.

Reads the #include lines of server/ and protocol/. A part may use itself and what lies below it; cloth and protocol
know nothing of each other or of anything above, and cloth knows no file, no socket, no JSON.
"""

import pathlib
import re
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]

ALLOWED = {
    "cloth": {"cloth"},
    "protocol": {"protocol"},
    "scene": {"scene", "cloth"},
    "study": {"study", "scene", "cloth"},
    "fabric": {"fabric", "scene", "cloth"},
    "include": {"include"},
    "library": {"library", "include", "scene", "cloth"},
    "record": {"record", "scene", "cloth"},
    "host": {"host", "record", "study", "scene", "cloth", "protocol"},
    "net": {"net", "host", "study", "scene", "cloth", "protocol"},
    "cli": {"cli", "net", "host", "record", "study", "fabric", "scene", "cloth", "protocol"},
}

# Headers that would bring files, sockets, JSON or logging into the simulation; sockets and logging into the formats.
FORBIDDEN_LIBRARIES = {
    "cloth": ("nlohmann/", "boost/", "spdlog/", "CLI/", "tiny_gltf", "filesystem", "fstream", "iostream", "sys/",
              "netinet/"),
    "protocol": ("boost/", "spdlog/", "CLI/", "tiny_gltf", "fcl/", "Eigen/", "sys/", "netinet/"),
    "scene": ("boost/", "spdlog/", "CLI/", "tiny_gltf", "fcl/", "sys/", "netinet/"),
    "study": ("boost/", "spdlog/", "CLI/", "tiny_gltf", "fcl/", "fstream", "filesystem", "sys/", "netinet/"),
    "fabric": ("boost/", "spdlog/", "CLI/", "tiny_gltf", "fcl/", "fstream", "filesystem", "sys/", "netinet/"),
}

# The folders of server/cloth, the lowest first: each uses itself and those before it.
ROOMS = ("core", "kernels", "shapes", "sheet", "solver", "air", "sleep", "bodies", "contact", "forces", "integrators", "levels",
         "guard", "world")

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def part_of(path, root):
    """The part a file belongs to, or None for files outside the house."""
    try:
        parts = path.resolve().relative_to(root.resolve()).parts
    except ValueError:
        return None
    if parts[0] == "protocol":
        return "protocol"
    return parts[1] if parts[0] == "server" and len(parts) > 2 else None


def included_part(name, file, root):
    """The part an include names: found next to the file, under server/ or under the root, else by its first word."""
    for base in (file.parent, root / "server", root):
        if (base / name).is_file():
            return part_of(base / name, root)
    first = name.split("/")[0]
    return first if "/" in name and first in ALLOWED else None


def violations(root):
    """Every include that breaks the order, as 'file:line: why'."""
    found = []
    files = [f for top in ("server", "protocol") for f in sorted((root / top).rglob("*"))]
    for file in files:
        if file.suffix not in (".h", ".cpp"):
            continue
        part = part_of(file, root)
        if part not in ALLOWED:
            found.append(f"{file.relative_to(root)}: in no part of the house")
            continue
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            quote, name = match.groups()
            where = f"{file.relative_to(root)}:{number}"
            target = included_part(name, file, root)
            if target is not None and target not in ALLOWED[part]:
                found.append(f"{where}: {part} must not know {target} ({name})")
            if quote == "<" and name.startswith(FORBIDDEN_LIBRARIES.get(part, ())):
                found.append(f"{where}: {part} must not use <{name}>")
    return found


def upward_includes(cloth):
    """The includes of server/cloth that name a header of a higher folder, as (file, header)."""
    found = set()
    for file in sorted(cloth.rglob("*")):
        if file.suffix not in (".h", ".cpp"):
            continue
        name = str(file.relative_to(cloth))
        for line in file.read_text(encoding="utf-8").splitlines():
            match = INCLUDE.match(line)
            if match and match[2].startswith("cloth/"):
                header = match[2].removeprefix("cloth/")
                if ROOMS.index(header.split("/")[0]) > ROOMS.index(name.split("/")[0]):
                    found.add((name, header))
    return found


class LayeringTest(unittest.TestCase):
    def test_the_folders_of_cloth_keep_their_order(self):
        self.assertEqual(upward_includes(ROOT / "server" / "cloth"), set())

    def test_the_house_keeps_its_order(self):
        self.assertEqual(violations(ROOT), [])

    def test_every_part_is_looked_at(self):
        seen = {part_of(f, ROOT) for top in ("server", "protocol") for f in (ROOT / top).rglob("*.h")}
        self.assertEqual(seen, set(ALLOWED))


class SelfTest(unittest.TestCase):
    """The check itself, on made-up houses."""

    def test_an_include_upwards_in_cloth_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            cloth = pathlib.Path(folder)
            for name, text in {"core/grid.h": '#include "cloth/sheet/plate.h"\n', "sheet/plate.h": '#include "cloth/core/grid.h"\n'}.items():
                (cloth / name).parent.mkdir()
                (cloth / name).write_text(text, encoding="utf-8")
            self.assertEqual(upward_includes(cloth), {("core/grid.h", "sheet/plate.h")})

    def check(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                path = root / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            return violations(root)

    def test_includes_downwards_pass(self):
        self.assertEqual(
            self.check({
                "server/cli/main.cpp": '#include "net/server.h"\n#include "protocol/frame.h"\n',
                "server/net/server.h": '#include "host/host.h"\n#include <boost/beast.hpp>\n',
                "server/host/host.h": '#include "scene/scene.h"\n#include "protocol/frame.h"\n',
                "server/scene/scene.h": '#include "cloth/world/cloth.h"\n#include <nlohmann/json.hpp>\n',
                "server/cloth/world/cloth.h": '#include "cloth/forces/effect.h"\n#include <vector>\n',
                "protocol/frame.h": '#include "protocol/grid_codec.h"\n',
            }), [])

    def test_an_include_upwards_is_caught(self):
        for part, name in (("cloth", "scene/scene.h"), ("cloth", "protocol/frame.h"), ("scene", "host/host.h"),
                           ("scene", "protocol/frame.h"), ("study", "host/host.h"), ("scene", "study/study.h"),
                           ("host", "net/server.h"), ("net", "cli/commands.h")):
            found = self.check({f"server/{part}/a.cpp": f'#include <vector>\n  #  include "{name}"\n'})
            upper = name.split("/")[0]
            self.assertEqual(found, [f"server/{part}/a.cpp:2: {part} must not know {upper} ({name})"])

    def test_protocol_knows_nobody(self):
        for name in ("cloth/grid.h", "scene/scene.h", "host/host.h"):
            self.assertEqual(len(self.check({"protocol/frame_decoder.cpp": f'#include "{name}"\n'})), 1, name)

    def test_a_way_round_by_dots_or_by_angle_brackets_is_caught(self):
        files = {"server/host/host.h": "", "server/cloth/a.cpp": '#include "../host/host.h"\n'}
        self.assertEqual(len(self.check(files)), 1)
        self.assertEqual(len(self.check({"server/cloth/a.cpp": "#include <host/host.h>\n"})), 1)

    def test_a_forbidden_library_is_caught(self):
        for name in ("nlohmann/json.hpp", "fstream", "boost/asio.hpp"):
            self.assertEqual(len(self.check({"server/cloth/a.h": f"#include <{name}>\n"})), 1, name)

    def test_a_file_in_no_part_is_caught(self):
        self.assertEqual(len(self.check({"server/misc/a.cpp": ""})), 1)


class Tests(unittest.TestCase):
    def test_every_file_of_tests_is_compiled(self):
        lists = {path.parent: path.read_text() for path in (ROOT / "tests").rglob("CMakeLists.txt")}
        for path in (ROOT / "tests").rglob("*_test.cpp"):
            self.assertTrue(any(str(path.relative_to(folder)) in text for folder, text in lists.items() if folder in path.parents),
                            f"{path} is in no CMakeLists.txt")


if __name__ == "__main__":
    unittest.main()
