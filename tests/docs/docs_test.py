"""Documents: links lead somewhere, the README is short, and nobody is sent to a file that is gone."""
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTS = [ROOT / name for name in
             subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()]
MAX_LINES, MAX_BYTES, MAX_COLUMNS = 250, 15_000, 120  # of the README: what one reads in ten minutes


def anchors(document):
    """The anchors of a document's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.*)$", document.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Documents(unittest.TestCase):
    def test_links_lead_somewhere(self):
        self.assertGreater(len(DOCUMENTS), 5)
        for document in DOCUMENTS:
            for target in re.findall(r"\]\(([^)\s]+)\)", document.read_text()):
                with self.subTest(document=str(document.relative_to(ROOT)), target=target):
                    if re.match(r"[a-z]+:", target):
                        continue
                    path, _, anchor = target.partition("#")
                    file = (document.parent / path) if path else document
                    self.assertTrue(file.exists())
                    self.assertTrue(file.resolve().is_relative_to(ROOT))
                    if anchor:
                        self.assertIn(anchor, anchors(file))

    def test_the_readme_is_short(self):
        text = (ROOT / "README.md").read_text()
        self.assertLessEqual(len(text.splitlines()), MAX_LINES)
        self.assertLessEqual(len(text.encode()), MAX_BYTES)

    def test_lines_can_be_read(self):
        for document in DOCUMENTS:
            if document.name == "README.md" or document.parent.name == "docs":
                code = False
                for number, line in enumerate(document.read_text().splitlines(), 1):
                    code ^= line.startswith("```")
                    if not code and not line.startswith("|"):
                        self.assertLessEqual(len(line), MAX_COLUMNS, f"{document.relative_to(ROOT)}:{number}")


if __name__ == "__main__":
    unittest.main()
