#!/usr/bin/env python3
"""Writes whitted.gltf: everything at once, after the picture of T. Whitted, "An Improved Illumination Model for Shaded
Display", CACM 23(6), 1980: a ball of glass and a mirror over a checkered floor. Usage: whitted.py [FILE]"""

import math

from scene_file import SceneFile, aimed, png, turned


def checker(i):
    x, y = i % 64, i // 64
    return (205, 60, 45, 255) if (x // 32 + y // 32) % 2 else (225, 205, 90, 255)


def ripple(i):
    x, y = (i % 64 + 0.5) / 64, (i // 64 + 0.5) / 64
    dx, dy = 0.35 * math.cos(6 * math.pi * x), 0.35 * math.cos(4 * math.pi * y)
    length = math.sqrt(dx * dx + dy * dy + 1)
    return tuple(int(127.5 + 127.5 * c / length) for c in (dx, dy, 1)) + (255,)


def net(i):
    x, y = i % 16, i // 16
    return (60, 110, 60, 255 if x < 5 or y < 5 else 0)


scene = SceneFile(
    "whitted", __file__, bottom=(0.55, 0.5, 0.45), top=(0.45, 0.65, 1.0), illuminates=True, indirect=True, ambient=(0, 0, 0)
)
scene.expose(-0.5)
camera = scene.camera((0.1, 1.45, 5.4), (0.05, 0.75, 0), 36)
scene.lens(camera, aperture_radius=0.02, focus_distance=5.1, blades=7)
floor = scene.material("floor", (0.8, 0.8, 0.8), texture=png(64, 64, map(checker, range(64 * 64))))
scene.json["materials"][floor]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
    "KHR_texture_transform": {"scale": [8, 8]}
}
scene._use("KHR_texture_transform")
corners = [(-6, 0, 5), (6, 0, 5), (6, 0, -9), (-6, 0, -9)]
scene.mesh("floor", floor, corners, [0, 1, 2, 0, 2, 3], (0, 0, 0), texcoords=[(0, 1), (1, 1), (1, 0), (0, 0)])
glass = scene.glass("glass", 1.5, (0.92, 0.98, 0.95), 1.0, priority=1)
air = scene.glass("air", 1.0, priority=9, specular=(0, 0, 0))
mirror = scene.material("mirror", (0.02, 0.02, 0.02), specular=(1, 1, 1), shininess=500, mirror=(0.85, 0.87, 0.9))
clay = scene.material(
    "clay", (0.65, 0.5, 0.4), specular=(0.3, 0.3, 0.3), shininess=50, normal_map=png(64, 64, map(ripple, range(64 * 64)))
)
fence = scene.material("fence", (1, 1, 1), texture=png(16, 16, map(net, range(16 * 16))), cut_out=True)
scene.sphere("ball of glass", glass, 0.55, (-0.35, 1.15, 1.0))
scene.sphere("bubble in it", air, 0.3, (-0.35, 1.15, 1.0))
scene.sphere("mirror", mirror, 0.6, (0.75, 0.62, -0.2))
scene.sphere("clay", clay, 0.35, (-1.35, 0.35, 0.1))
scene.box("block", glass, (0.5, 0.7, 0.5), (1.6, 0.36, 0.9), rotation=turned((0, 1, 0), 25))
fence_corners = [(-0.9, 0, 0), (0.9, 0, 0), (0.9, 0.9, 0), (-0.9, 0.9, 0)]
scene.mesh(
    "fence", fence, fence_corners, [0, 1, 2, 0, 2, 3], (-1.2, 0, -1.2), texcoords=[(0, 4), (8, 4), (8, 0), (0, 0)], double_sided=True
)
scene.sphere("lamp", scene.material("lamp", emission=(12, 10, 7)), 0.22, (-2.0, 2.3, 0.6))
scene.light("sun", "directional", intensity=1.5, colour=(1, 0.95, 0.85), rotation=aimed((-0.5, -1, -0.7)))
scene.light("spot", "spot", (2.4, 3.2, 2.4), 14, (0.7, 0.8, 1), rotation=aimed((-2.3, -2.6, -2.2)), cone=(12, 24))
scene.write(__file__)
