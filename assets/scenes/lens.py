#!/usr/bin/env python3
"""Writes lens.gltf: a row of balls through a lens with six blades, sharp at the third. Usage: lens.py [FILE]"""

from scene_file import SceneFile

scene = SceneFile("lens", __file__, bottom=(0.02, 0.02, 0.03), top=(0.05, 0.06, 0.1), ambient=(0.6, 0.6, 0.7))
scene.expose(-1)
camera = scene.camera((0.9, 0.75, 2.4), (-0.25, 0.25, -0.6), 34)
scene.lens(camera, aperture_radius=0.05, focus_distance=2.62, blades=6, rotation=0.2)
floor = scene.material("floor", (0.25, 0.22, 0.2))
stripe = scene.material("stripe", (0.6, 0.56, 0.5))
scene.box("floor", floor, (30, 0.2, 30), (0, -0.1, 0))
for row in range(-30, 8):
    scene.box("stripe", stripe, (6, 0.01, 0.12), (0, 0, 0.3 * row))
colours = ((0.8, 0.2, 0.15), (0.85, 0.55, 0.1), (0.3, 0.7, 0.2), (0.15, 0.4, 0.8), (0.6, 0.25, 0.7), (0.7, 0.7, 0.7))
for i, colour in enumerate(colours):
    ball = scene.material(f"ball {i}", colour, specular=(0.8, 0.8, 0.8), shininess=120)
    scene.sphere(f"ball {i}", ball, 0.25, (0.35 - 0.3 * i, 0.25, 1.0 - 0.75 * i))
spark = scene.material("spark", emission=(40, 31, 18))
for i in range(24):
    scene.sphere("spark", spark, 0.02, (-7.5 + 0.62 * i, 0.6 + 0.9 * ((7 * i) % 5) / 4, -9.0 - 0.5 * ((3 * i) % 4)))
scene.light("lamp", "point", (1.5, 3, 2.5), 0.8, phong={"falloff": False, "shadows": True})
scene.write(__file__)
