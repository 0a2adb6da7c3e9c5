"""Every numeric constant of server/cloth stands in DECISIONS.md, under its file, with its present value."""
import pathlib
import re
import unittest

CLOTH = pathlib.Path(__file__).resolve().parents[3] / "server" / "cloth"
DECLARATION = re.compile(r"\bconstexpr\s+(?:int|unsigned|float|double|std::size_t|std::uint(?:8|16)_t)\s+(k[A-Z][^;]*);")


def constants(source):
    """The (name, value) of each numeric constant; the value as it is written, without qualifiers and suffixes."""
    for declaration in DECLARATION.findall(re.sub(r"//.*", "", source.read_text())):
        for name, value in re.findall(r"(k\w+)\s*=\s*([^,]+)", declaration):
            value = re.sub(r"std::numbers::|weft::|(?<=\d)F\b", "", " ".join(value.split()))
            # Not the value of another one, nor a number that nobody chose.
            if not re.fullmatch(r"k\w+|std::numeric_limits.*|static_cast.*", value) and name != "kPi":
                yield name, value


def listed():
    """By (file, name): the value's cell."""
    rows, file = {}, None
    for line in (CLOTH / "DECISIONS.md").read_text().splitlines():
        if heading := re.fullmatch(r"`([\w/.]+)`", line):
            file = heading[1]
        elif line.startswith("| `"):
            names, value = line.split(" | ")[:2]
            for name in re.findall(r"`(k\w+)`", names):
                rows[file, name] = value
    return rows


class Decisions(unittest.TestCase):
    def test_every_constant_is_listed_with_its_value(self):
        rows, seen = listed(), set()
        for source in sorted(CLOTH.rglob("*.h")) + sorted(CLOTH.rglob("*.cpp")):
            file = str(source.relative_to(CLOTH))
            for name, value in constants(source):
                seen.add((file, name))
                with self.subTest(file=file, constant=name):
                    cell = rows.get((file, name))
                    self.assertIsNotNone(cell, "is not in DECISIONS.md")
                    self.assertRegex(cell, rf"(?<![\w.]){re.escape(value)}(?![\w.])")
        self.assertGreater(len(seen), 100)

    def test_nothing_is_listed_that_is_gone(self):
        for file, name in listed():
            with self.subTest(file=file, constant=name):
                self.assertTrue(re.search(rf"\b{name}\b", (CLOTH / file).read_text()))


if __name__ == "__main__":
    unittest.main()
