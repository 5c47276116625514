#!/usr/bin/env python3
"""Writes soft-shadows.gltf: a ball, a panel and a triangle that glow, over matt bodies. Usage: soft-shadows.py [FILE]"""

from scene_file import SceneFile

scene = SceneFile("soft shadows", __file__, bottom=(0.02, 0.02, 0.02), top=(0.03, 0.04, 0.06), ambient=(0.15, 0.15, 0.18))
scene.expose(-0.5)
scene.camera((0, 2.1, 5.2), (0, 0.4, 0), 38)
grey = scene.material("grey", (0.7, 0.7, 0.7))
red = scene.material("red", (0.75, 0.25, 0.2))
blue = scene.material("blue", (0.25, 0.35, 0.75))
scene.box("floor", grey, (14, 0.2, 14), (0, -0.1, 0))
scene.box("wall", grey, (14, 6, 0.2), (0, 3, -2.6))
scene.sphere("ball", red, 0.5, (-0.9, 0.5, 0))
scene.box("pillar", blue, (0.4, 1.3, 0.4), (0.55, 0.65, -0.4), rotation=[0, 0.3420201, 0, 0.9396926])
scene.sphere("small ball", grey, 0.22, (0.2, 0.22, 0.9))
scene.sphere("lamp", scene.material("warm", emission=(84, 60, 36)), 0.25, (-2.1, 2.1, 1.0))
panel = scene.material("cool", emission=(13, 18, 25))
scene.mesh("panel", panel, [(-0.7, 0, -0.5), (0.7, 0, -0.5), (0.7, 0, 0.5), (-0.7, 0, 0.5)], [0, 1, 2, 0, 2, 3], (1.4, 2.6, -0.3))
green = scene.material("green", emission=(9, 36, 12))
scene.mesh("triangle", green, [(0, 0, 0.3), (0.3, 0, -0.2), (-0.3, 0, -0.2)], [0, 2, 1], (-0.2, 1.9, -1.6))
scene.write(__file__)
