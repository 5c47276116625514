#!/usr/bin/env python3
"""Writes metals.gltf: balls from smooth to rough, of gold, of plastic and of what lies between. Usage: metals.py [FILE]"""

from scene_file import SceneFile, png

scene = SceneFile(
    "metals", __file__, bottom=(0.12, 0.11, 0.1), top=(0.5, 0.62, 0.8), ambient=(0, 0, 0), illuminates=True, indirect=True
)
scene.camera((0.0, 2.6, 6.4), (0, 0.85, 0), 34)


def tile(x, y):
    """Steel with patches of rust: green is the roughness, blue the metal."""
    worn = ((x // 4) * 7 + (y // 4) * 5 + (x // 4) * (y // 4)) % 11 < 4
    return (255, 200, 30, 255) if worn else (255, 70 + 3 * (x % 8), 255, 255)


floor = scene.microfacets("floor", (0.35, 0.33, 0.3), 0, 0.45)
wall = scene.microfacets("wall", (0.5, 0.45, 0.42), 0, 0.9)
scene.box("floor", floor, (14, 0.2, 10), (0, -0.1, 0))
scene.box("wall", wall, (14, 6, 0.2), (0, 2.9, -2.2))
for i in range(5):
    step = i / 4
    x = -2.2 + 1.1 * i
    gold = scene.microfacets(f"gold {i}", (1.0, 0.78, 0.34), 1, step)
    scene.sphere(f"gold {i}", gold, 0.45, (x, 0.45, 0.9))
    plastic = scene.microfacets(f"plastic {i}", (0.6, 0.06, 0.05), 0, step)
    scene.sphere(f"plastic {i}", plastic, 0.45, (x, 0.45, -0.3))
    between = scene.microfacets(f"between {i}", (0.55, 0.6, 0.65), step, 0.3)
    scene.sphere(f"between {i}", between, 0.45, (x, 1.55, -1.2))
worn = scene.microfacets("worn steel", (0.7, 0.68, 0.66), 1, 1, texture=png(32, 32, (tile(i % 32, i // 32) for i in range(1024))))
scene.box("worn block", worn, (0.6, 0.6, 0.6), (1.75, 0.3, 2.1), rotation=[0, 0.26, 0, 0.966])
lacquer = scene.microfacets("lacquer", (0.02, 0.05, 0.1), 0, 0.05, ior=2.0)
scene.sphere("lacquer", lacquer, 0.3, (-1.7, 0.3, 2.1), scale=(1.3, 1, 1))
lamp = scene.material("lamp", emission=(14, 12.5, 10))
scene.sphere("lamp", lamp, 0.35, (-2.4, 3.6, 1.6))
scene.light("spark", "point", (2.5, 3.2, 2.5), 3)
scene.write(__file__)
