#!/usr/bin/env python3
"""Writes motion.gltf: balls that fly, bounce and circle, and a cube that spins, before a shutter that is open for half of
each frame. Usage: motion.py [FILE]"""

from scene_file import SceneFile, turned

scene = SceneFile("motion", __file__, bottom=(0.5, 0.5, 0.55), top=(0.2, 0.3, 0.5), ambient=(1.6, 1.6, 1.8))
scene.frame_rate(8)
scene.expose(-0.5)
camera = scene.camera((0, 1.5, 4.6), (0, 0.72, 0), 34)
scene.shutter(camera, 0, 1 / 16, instants=36)
floor = scene.material("floor", (0.6, 0.57, 0.52))
scene.box("floor", floor, (30, 0.2, 30), (0, -0.1, 0))


def glossy(name, colour):
    return scene.material(name, colour, specular=(0.7, 0.7, 0.7), shininess=80)


# one that rests, to compare with
scene.sphere("resting ball", glossy("green", (0.2, 0.55, 0.25)), 0.25, (-1.35, 0.25, 0.45))

flying = scene.sphere("flying ball", glossy("red", (0.75, 0.15, 0.12)), 0.25, (-2.9, 1.75, -0.6))
scene.animate(flying, "translation", (0, 1), [(-2.9, 1.75, -0.6), (2.4, 1.75, -0.6)])

# 0.8 m high in half a second: a parabola is a cubic spline of one piece
bouncing = scene.sphere("bouncing ball", glossy("orange", (0.85, 0.5, 0.1)), 0.25, (-0.6, 0.25, 0.2))
on_floor, up, down, no = (-0.6, 0.25, 0.2), (0, 6.4, 0), (0, -6.4, 0), (0, 0, 0)
scene.animate(
    bouncing, "translation", (0, 0.5, 1), [no, on_floor, up, down, on_floor, up, down, on_floor, no], "CUBICSPLINE"
)

quarters = (0, 0.25, 0.5, 0.75, 1)
wheel = scene.node("wheel", (0.55, 0.85, -0.4))
scene.animate(wheel, "rotation", quarters, [turned((0, 0, 1), -90 * i) for i in range(5)])
blue = glossy("blue", (0.15, 0.35, 0.75))
for i, (x, y) in enumerate(((0.5, 0), (0.25, 0.433), (-0.25, 0.433), (-0.5, 0), (-0.25, -0.433), (0.25, -0.433))):
    scene.sphere(f"ball {i}", blue, 0.13, (x, y, 0), parent=wheel)

spinning = scene.box("spinning cube", glossy("white", (0.7, 0.7, 0.65)), (0.5, 0.5, 0.5), (1.35, 0.25, 0.5))
scene.animate(spinning, "rotation", quarters, [turned((0, 1, 0), 120 * i) for i in range(5)])

scene.light("lamp", "point", (1.8, 3.5, 3), 1, phong={"falloff": False, "shadows": True})
scene.write(__file__)
