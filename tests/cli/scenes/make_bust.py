#!/usr/bin/python3
"""Writes a bust to standard output, a Wavefront OBJ file of 5,000 triangles, 0.7 m high: make_bust.py > bust.obj"""
import math

RINGS, SECTORS = 51, 50  # 2 SECTORS (RINGS - 1) triangles


def bump(x, centre, width):
    return math.exp(-((x - centre) / width) ** 2)


def radius(height, round_):
    """Of the bust at a height of -0.35 to 0.35 m, in a direction around the y axis; the face looks along +z, round_ = pi / 2."""
    front = abs(math.remainder(round_ - math.pi / 2, 2 * math.pi))
    head = 0.115 * math.sqrt(max(0.0, 1 - ((height - 0.2) / 0.15) ** 2)) if abs(height - 0.2) < 0.15 else 0.0
    neck = 0.05 * bump(height, 0.0, 0.12)
    shoulders = 0.22 * bump(height, -0.22, 0.11) * (0.6 + 0.4 * math.cos(round_) ** 2)
    nose = 0.035 * bump(height, 0.19, 0.03) * bump(front, 0, 0.25)
    chin = 0.015 * bump(height, 0.09, 0.03) * bump(front, 0, 0.5)
    brow = 0.01 * bump(height, 0.25, 0.02) * bump(front, 0, 0.8)
    return math.hypot(head, neck, shoulders) + nose + chin + brow


def main():
    def place(ring, sector):
        down, round_ = math.pi * ring / RINGS, 2 * math.pi * sector / SECTORS
        height = 0.35 * math.cos(down)
        # The two ends are single points; towards them everything closes.
        size = radius(height, round_) * min(1.0, 2 * math.sin(down))
        return size * math.cos(round_), height, size * math.sin(round_)

    def vertex(ring, sector):  # counted from 1
        if ring in (0, RINGS):
            return 1 if ring == 0 else 2
        return 3 + (ring - 1) * SECTORS + sector % SECTORS

    print("# tests/cli/scenes/make_bust.py\nv 0 0.35 0\nv 0 -0.35 0")
    for ring in range(1, RINGS):
        for sector in range(SECTORS):
            print("v {:.6f} {:.6f} {:.6f}".format(*place(ring, sector)))
    for ring in range(RINGS):
        for sector in range(SECTORS):
            corners = [vertex(ring, sector), vertex(ring, sector + 1), vertex(ring + 1, sector + 1), vertex(ring + 1, sector)]
            if ring > 0:
                print("f", *corners[:3])
            if ring < RINGS - 1:
                print("f", corners[0], *corners[2:])


main()
