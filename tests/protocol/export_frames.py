"""Frames, told as JSON on standard input, written by the Python client: as .glb and .obj into the folder that is named."""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "protocol" / "clients" / "python"))
import numpy as np  # noqa: E402
import weft  # noqa: E402


def frame(f, told):
    cloths = [weft.Cloth(each["cloth"], 4, 4, 0.0, np.array(each["positions"], np.float32).reshape(each["rows"], each["cols"], 3),
                         each["torn"]) for each in told["cloths"]]
    return weft.Frame(weft.Stamp(f, told["epoch"], told["time"], 0, False, False), cloths, [], [])


folder = pathlib.Path(sys.argv[1])
frames = [frame(f, told) for f, told in enumerate(json.load(sys.stdin))]
try:
    weft.write_glb(folder / "frames.glb", frames)
except ValueError as error:
    sys.exit(str(error))
weft.write_obj(folder / "frame.obj", frames[-1])
