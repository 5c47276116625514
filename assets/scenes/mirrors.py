#!/usr/bin/env python3
"""Writes mirrors.gltf: two mirrors that face each other, with a few bodies between them. Usage: mirrors.py [FILE]"""

from scene_file import SceneFile

scene = SceneFile("mirrors", __file__, bottom=(0.35, 0.35, 0.4), top=(0.5, 0.65, 0.9), ambient=(0.8, 0.8, 0.8))
scene.expose(-0.5)
scene.camera((1.2, 1.2, 1.0), (-1.5, 0.75, -0.75), 50)
floor = scene.material("floor", (0.55, 0.5, 0.45))
tile = scene.material("tile", (0.25, 0.22, 0.2))
frame = scene.material("frame", (0.35, 0.2, 0.1), specular=(0.3, 0.3, 0.3))
mirror = scene.material("mirror", (0.01, 0.01, 0.01), mirror=(0.86, 0.9, 0.88))
gold = scene.material("gold", (0.06, 0.04, 0.01), specular=(1, 0.8, 0.4), shininess=400, mirror=(0.9, 0.7, 0.35))
red = scene.material("red", (0.75, 0.12, 0.1), specular=(0.6, 0.6, 0.6), shininess=80)
blue = scene.material("blue", (0.1, 0.2, 0.7), specular=(0.6, 0.6, 0.6), shininess=80)
scene.box("floor", floor, (12, 0.2, 12), (0, -0.1, 0))
for row in range(-4, 5):
    for column in range(-4, 5):
        if (row + column) % 2 == 0:
            scene.box("tile", tile, (0.5, 0.02, 0.5), (0.5 * column, 0, 0.5 * row))
for side, name in ((-1, "left"), (1, "right")):
    scene.box(f"{name} mirror", mirror, (0.04, 1.8, 2.6), (1.5 * side, 1.0, -0.6))
    scene.box(f"{name} frame", frame, (0.03, 2.0, 2.8), (1.53 * side, 1.02, -0.6))
scene.sphere("golden ball", gold, 0.42, (-0.35, 0.43, -0.9))
scene.sphere("red ball", red, 0.28, (0.45, 0.29, -0.3))
scene.box("block", blue, (0.3, 0.5, 0.3), (0.25, 0.26, -1.3), rotation=[0, 0.3826834, 0, 0.9238795])
scene.light("lamp", "point", (0.4, 3.2, 2.0), 0.75, phong={"falloff": False, "shadows": True})
scene.write(__file__)
