"""The same bits from another version of the kernels than this processor's own: Valgrind's processor has no AVX-512, so that where this one
has, the table's hashes, which cli_test.py finds with it, are found without it."""
import json
import os
import pathlib
import re
import subprocess
import unittest

WEFT = os.environ["WEFT_BINARY"]
TABLE = json.loads(pathlib.Path(__file__).with_name("hashes.json").read_text())
LIMIT_S = 120


class InstructionSets(unittest.TestCase):
    @unittest.skipUnless(re.search(r"\bavx512f\b", pathlib.Path("/proc/cpuinfo").read_text()), "one version of the kernels is all there is")
    def test_hashes_do_not_depend_on_the_version_of_the_kernels(self):
        for scene, expected in TABLE["scenes"].items():
            with self.subTest(scene=scene):
                result = subprocess.run(["valgrind", "--quiet", "--tool=none", WEFT, "run", scene, *TABLE["options"], "--hash"],
                                        check=True, capture_output=True, text=True, timeout=LIMIT_S)
                self.assertEqual(result.stdout.splitlines()[-1], expected)


if __name__ == "__main__":
    unittest.main()
