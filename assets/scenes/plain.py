#!/usr/bin/env python3
"""Writes plain.gltf: nothing but Phong's model. Four lights without shadows over sixty bodies. Usage: plain.py [FILE]"""

import math

from scene_file import SceneFile

scene = SceneFile("plain", __file__)
scene.camera((0, 4.5, 9), (0, 0, 0), 40)
materials = [
    scene.material(name, diffuse, specular=(0.6, 0.6, 0.6), shininess=48)
    for name, diffuse in (("red", (0.8, 0.2, 0.2)), ("green", (0.2, 0.7, 0.3)), ("blue", (0.2, 0.3, 0.8)))
]
floor = scene.material("floor", (0.6, 0.6, 0.55))
scene.box("floor", floor, (14, 0.2, 14), (0, -0.6, 0))
for i in range(59):
    angle, distance = 2.39996 * i, 0.52 * math.sqrt(i + 0.5)
    at = (distance * math.cos(angle), -0.5 + 0.2 + 0.004 * i, distance * math.sin(angle))
    if i % 4 == 3:
        scene.box(f"box {i}", materials[i % 3], (0.36, 0.4, 0.36), at)
    else:
        scene.sphere(f"ball {i}", materials[i % 3], 0.2 + 0.004 * i, at)
for name, at, colour in (
    ("left", (-5, 6, 4), (1, 0.9, 0.8)),
    ("right", (6, 5, 3), (0.5, 0.5, 0.7)),
    ("back", (0, 7, -6), (0.4, 0.4, 0.4)),
    ("front", (0, 2, 9), (0.2, 0.2, 0.2)),
):
    scene.light(name, "point", at, 0.7, colour, phong={"falloff": False, "shadows": False})
scene.write(__file__)
