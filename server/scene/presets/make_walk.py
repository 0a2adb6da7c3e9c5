#!/usr/bin/env python3
"""Writes walk.bvh: a figure of 1.73 m walks round a circle of 0.9 m, five strides of 1.1 s, and then again.

Made for Weft, from sines: nobody was recorded. Lengths are in cm, y is up, the figure faces +z at rest with its
arms down. The hips are as high as the lower ankle needs to stay on the ground.
"""
import math
import pathlib

STRIDES, STRIDE, RATE, RADIUS, ANKLE = 5, 1.1, 30, 90, 8
THIGH, SHIN = 43, 41
JOINTS = [  # name, parent, offset, channels; a name of None ends its parent
    ("Hips", None, (0, 0, 0), "Xposition Yposition Zposition Yrotation Xrotation Zrotation"),
    ("Spine", "Hips", (0, 10, 0), "Xrotation Yrotation"),
    ("Chest", "Spine", (0, 22, 0), ""),
    ("Neck", "Chest", (0, 23, 0), "Yrotation"),
    ("Head", "Neck", (0, 8, 1), ""),
    (None, "Head", (0, 16, 0), ""),
    ("LeftCollar", "Chest", (4, 17, 0), ""),
    ("LeftArm", "LeftCollar", (15, 0, 0), "Zrotation Xrotation"),
    ("LeftForeArm", "LeftArm", (0, -29, 0), "Xrotation"),
    ("LeftHand", "LeftForeArm", (0, -26, 0), ""),
    (None, "LeftHand", (0, -17, 0), ""),
    ("RightCollar", "Chest", (-4, 17, 0), ""),
    ("RightArm", "RightCollar", (-15, 0, 0), "Zrotation Xrotation"),
    ("RightForeArm", "RightArm", (0, -29, 0), "Xrotation"),
    ("RightHand", "RightForeArm", (0, -26, 0), ""),
    (None, "RightHand", (0, -17, 0), ""),
    ("LeftUpLeg", "Hips", (9, -3, 0), "Xrotation"),
    ("LeftLeg", "LeftUpLeg", (0, -THIGH, 0), "Xrotation"),
    ("LeftFoot", "LeftLeg", (0, -SHIN, 0), "Xrotation"),
    (None, "LeftFoot", (0, -6, 14), ""),
    ("RightUpLeg", "Hips", (-9, -3, 0), "Xrotation"),
    ("RightLeg", "RightUpLeg", (0, -THIGH, 0), "Xrotation"),
    ("RightFoot", "RightLeg", (0, -SHIN, 0), "Xrotation"),
    (None, "RightFoot", (0, -6, 14), ""),
]


def hierarchy(name, depth=0):
    """Lines of the joint and all below it."""
    joint = next(j for j in JOINTS if j[0] == name)
    channels = joint[3].split()
    pad = "  " * depth
    lines = [f"{pad}{'ROOT' if joint[1] is None else 'JOINT'} {name}", pad + "{",
             f"{pad}  OFFSET {joint[2][0]} {joint[2][1]} {joint[2][2]}",
             f"{pad}  CHANNELS {len(channels)} {' '.join(channels)}".rstrip()]
    for child, parent, offset, _ in JOINTS:
        if parent != name:
            continue
        if child is None:
            lines += [pad + "  End Site", pad + "  {", f"{pad}    OFFSET {offset[0]} {offset[1]} {offset[2]}", pad + "  }"]
        else:
            lines += hierarchy(child, depth + 1)
    return lines + [pad + "}"]


def leg(phase):
    """Degrees about x of hip, knee and ankle: the knee bends while the leg swings forwards."""
    hip = -4 - 24 * math.sin(phase)
    knee = 8 + 44 * max(0.0, math.cos(phase)) ** 2
    return hip, knee, -0.6 * (hip + knee)


def drop(angles):
    """From the hip joint down to the ankle."""
    hip, knee = math.radians(angles[0]), math.radians(angles[0] + angles[1])
    return THIGH * math.cos(hip) + SHIN * math.cos(knee)


def frame(i, count):
    """A frame's numbers, in the order of the channels."""
    way = 2 * math.pi * i / count
    phase = STRIDES * way
    swing = math.sin(phase)
    left, right = leg(phase), leg(phase + math.pi)
    hips = [RADIUS * math.cos(way), ANKLE + 3 + max(drop(left), drop(right)), -RADIUS * math.sin(way),
            180 + math.degrees(way) - 5 * swing, 3, 0]
    spine = [0, 9 * swing]
    neck = [-4 * swing]
    arm = {side: [side * 9, 20 * side * swing, -18 + 10 * side * swing] for side in (1, -1)}
    return hips + spine + neck + arm[1] + arm[-1] + list(left) + list(right)


def main():
    count = round(STRIDES * STRIDE * RATE)
    lines = ["HIERARCHY", *hierarchy("Hips"), "MOTION", f"Frames: {count + 1}", f"Frame Time: {1 / RATE:.10f}"]
    for i in range(count + 1):
        lines.append(" ".join(f"{number:.2f}".rstrip("0").rstrip(".") for number in frame(i, count)))
    text = "\n".join(lines).replace("-0 ", "0 ") + "\n"
    pathlib.Path(__file__).with_name("walk.bvh").write_text(text)


if __name__ == "__main__":
    main()
