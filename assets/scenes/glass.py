#!/usr/bin/env python3
"""Writes glass.gltf: balls of glass within each other, and a cube of glass with water in it, in which total internal
reflection is to be seen. Usage: glass.py [FILE]"""

from scene_file import SceneFile, turned

scene = SceneFile("glass", __file__, bottom=(0.5, 0.45, 0.4), top=(0.5, 0.7, 1), ambient=(1, 1, 1))
scene.expose(-0.5)
scene.camera((0.2, 1.5, 4.6), (0, 0.45, 0), 36)
light_tile = scene.material("light tile", (0.75, 0.72, 0.66), ambient=(0.25, 0.24, 0.22))
dark_tile = scene.material("dark tile", (0.2, 0.12, 0.1), ambient=(0.07, 0.04, 0.04))
red = scene.material("red", (0.8, 0.1, 0.08), ambient=(0.2, 0.03, 0.02), specular=(0.5, 0.5, 0.5), shininess=60)
# What lies within wins over what lies around it. The water reaches a little into the glass, so that no gap is left.
clear = scene.glass("clear glass", 1.5, priority=3)
green = scene.glass("green glass", 1.5, (0.55, 0.95, 0.7), 0.8, priority=3)
water = scene.glass("water", 1.33, (0.7, 0.9, 1), 1.2, priority=10)
amber = scene.glass("amber", 1.55, (1, 0.6, 0.15), 0.35, priority=10)
air = scene.glass("air", 1.0, priority=9, specular=(0, 0, 0))
for row in range(-8, 5):
    for column in range(-7, 8):
        tile = light_tile if (row + column) % 2 == 0 else dark_tile
        scene.box("tile", tile, (0.4, 0.1, 0.4), (0.4 * column, -0.05, 0.4 * row))
# a hollow ball: glass, and air within it; and in the air a ball of amber
scene.sphere("hollow ball", clear, 0.55, (-1.15, 0.56, 0))
scene.sphere("air in the ball", air, 0.47, (-1.15, 0.56, 0))
scene.sphere("amber in the air", amber, 0.22, (-1.15, 0.5, 0))
scene.sphere("solid ball", clear, 0.3, (-0.25, 0.31, 0.9))
# a cube of glass, hollow, and water in the hollow; a red ball in the water
spin = turned((0, 1, 0), 32)
scene.box("cube", green, (1.1, 1.0, 1.1), (0.75, 0.51, -0.2), rotation=spin)
scene.box("hollow in the cube", air, (0.96, 0.86, 0.96), (0.75, 0.51, -0.2), rotation=spin)
scene.box("water in the hollow", water, (0.98, 0.5, 0.98), (0.75, 0.32, -0.2), rotation=spin)
scene.sphere("ball in the water", red, 0.15, (0.75, 0.25, -0.2))
scene.sphere("behind the cube", red, 0.25, (1.5, 0.26, -1.4))
scene.light("lamp", "point", (-2.5, 4, 3), 0.7, phong={"falloff": False, "shadows": True})
scene.write(__file__)
