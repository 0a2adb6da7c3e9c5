"""viewer_check.py PROGRAM: the outside viewer against a real server; fails unless it sees what it should."""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "service"))
from serving import Server  # noqa: E402

LIMIT_S = 120
EXPECTED = "flag: 17 x 17 nodes, range /speed\n"  # flag.json: level 4 beyond 8 m

with Server("flag") as server:
    done = subprocess.run([sys.argv[1], server.url("flag")], capture_output=True, text=True, timeout=LIMIT_S)
if (done.returncode, done.stdout) != (0, EXPECTED):
    sys.exit(f"the viewer ended with {done.returncode} and said {done.stdout!r}, not {EXPECTED!r}; {done.stderr}")
