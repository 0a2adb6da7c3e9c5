"""Frames and a scene, told as JSON on standard input, written by the Python client: as .glb and .obj into the folder that is named."""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "protocol" / "clients" / "python"))
import numpy as np  # noqa: E402
import weft  # noqa: E402


def frame(f, told):
    cloths = [weft.Cloth(each["cloth"], 4, 4, 0.0, np.array(each["positions"], np.float32).reshape(each["rows"], each["cols"], 3),
                         each["torn"]) for each in told["cloths"]]
    balls = [weft.Ball(each["ball"], each["position"], each["radius"], each["motion"]) for each in told["balls"]]
    moved = [weft.MovedObstacle(each["obstacle"], each["position"], each["quaternion"]) for each in told["obstacles"]]
    return weft.Frame(weft.Stamp(f, told["epoch"], told["time"], 0, False, False), cloths, balls, moved)


folder = pathlib.Path(sys.argv[1])
told = json.load(sys.stdin)
frames = [frame(f, each) for f, each in enumerate(told["frames"])]
surfaces = {index: surface for index, surface in enumerate(told["surfaces"]) if surface}
try:
    weft.write_glb(folder / "frames.glb", frames, told.get("scene"), surfaces)
except ValueError as error:
    sys.exit(str(error))
weft.write_obj(folder / "frame.obj", frames[-1], told.get("scene"), surfaces)
