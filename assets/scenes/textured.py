#!/usr/bin/env python3
"""Writes textured.gltf: a globe, a crate, a bumpy egg and a sheet with holes, with pictures made here.
Usage: textured.py [FILE]"""

import math

from scene_file import SceneFile, png, turned


def globe(x, y):
    """Meridians and parallels over a sea with some land."""
    land = math.sin(5 * x) * math.cos(3.1 * y + 1) + 0.6 * math.sin(11 * x + 4 * y)
    line = min(x * 6 % math.pi, y * 6 % math.pi) < 0.16
    return (235, 235, 220, 255) if line else (70, 140, 60, 255) if land > 0.45 else (40, 80, 170, 255)


def crate(x, y):
    edge = min(x, y, 1 - x, 1 - y) < 0.1 or abs(x - y) < 0.07
    grain = int(18 * math.sin(60 * x + 3 * math.sin(9 * y)))
    return (120 + grain, 78 + grain // 2, 40, 255) if edge else (178 + grain, 130 + grain, 76, 255)


def leaf(x, y):
    hole = math.hypot(x % 0.25 - 0.125, y % 0.25 - 0.125) < 0.075
    return (200, 60, 50, 0 if hole else 255)


def bump(x, y):
    dx, dy = math.cos(8 * math.pi * x), math.cos(8 * math.pi * y)
    length = math.sqrt(dx * dx + dy * dy + 4)
    return tuple(int(127.5 + 127.5 * c / length) for c in (dx, dy, 2)) + (255,)


def picture(size, colour, width=1.0, height=1.0):
    return png(size, size, [colour(width * (i % size + 0.5) / size, height * (i // size + 0.5) / size) for i in range(size * size)])


scene = SceneFile("textured", __file__, ambient=(1, 1, 1))
scene.expose(-0.5)
scene.camera((0.3, 1.5, 4.3), (0, 0.45, 0), 36)
plain = {"specular": (0.25, 0.25, 0.25), "shininess": 40}
earth = scene.material("earth", (1, 1, 1), texture=picture(256, globe, 2 * math.pi, math.pi), **plain)
wood = scene.material("wood", (1, 1, 1), texture=picture(128, crate), **plain)
net = scene.material("net", (1, 1, 1), texture=picture(64, leaf), cut_out=True, **plain)
egg = scene.material("egg", (0.8, 0.75, 0.6), normal_map=picture(128, bump), specular=(0.5, 0.5, 0.5), shininess=60)
floor = scene.material("floor", (0.6, 0.58, 0.52))
scene.box("floor", floor, (10, 0.2, 10), (0, -0.1, 0))
scene.sphere("globe", earth, 0.55, (-0.95, 0.56, 0), rotation=turned((0, 0, 1), -23.4))
scene.box("crate", wood, (0.8, 0.8, 0.8), (0.95, 0.41, -0.2), rotation=turned((0, 1, 0), 28))
scene.sphere("egg", egg, 0.26, (0.15, 0.34, 0.75), scale=(1, 1.3, 1))
corners = [(-0.5, 0, 0), (0.5, 0, 0), (0.5, 0.9, 0), (-0.5, 0.9, 0)]
scene.mesh("net", net, corners, [0, 1, 2, 0, 2, 3], (-0.05, 0.02, -0.7), texcoords=[(0, 1), (1, 1), (1, 0), (0, 0)], double_sided=True)
scene.light("lamp", "point", (-2, 4, 3), 0.75, phong={"falloff": False, "shadows": True})
scene.write(__file__)
