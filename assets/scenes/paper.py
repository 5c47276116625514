#!/usr/bin/env python3
"""Writes paper.gltf, the scene of docs/paper.md: the same numbers as named_scene("paper"), to the last bit.

Usage: paper.py [FILE]   FILE defaults to paper.gltf beside this script; - is standard output.
"""

import base64
import json
import math
import os
import struct
import sys

from scene_file import float32, floats

FRAMES = 120
FRAMES_PER_SECOND = 24


def material(name, diffuse):
    diffuse = floats(diffuse)
    phong = {
        "ambient": floats(float32(0.1) * value for value in diffuse),
        "diffuse": diffuse,
        "specular": [1, 1, 1],
        "shininess": 32,
    }
    return {
        "name": name,
        "pbrMetallicRoughness": {"baseColorFactor": diffuse + [1]},
        "extensions": {"TANDEM_materials_phong": phong},
    }


def shape_mesh(name, shape, material_index):
    primitive = {"material": material_index, "extensions": {"EXT_implicit_geometry": shape}}
    return {"name": name, "primitives": [primitive]}


def circling(position):
    """One key per frame and one more that closes the circle."""
    keys = []
    for frame in range(FRAMES + 1):
        angle = 2 * math.pi * (frame % FRAMES) / FRAMES
        keys.append(floats(position(math.sin(angle), math.cos(angle))))
    return keys


class Buffer:
    """One buffer, filled with arrays of floats, and the accessors that read them."""

    def __init__(self):
        self.data = b""
        self.views = []
        self.accessors = []

    def add(self, kind, elements):
        packed = b"".join(struct.pack(f"<{len(element)}f", *element) for element in elements)
        self.accessors.append(
            {
                "bufferView": len(self.views),
                "componentType": 5126,
                "count": len(elements),
                "type": kind,
                "min": [min(column) for column in zip(*elements)],
                "max": [max(column) for column in zip(*elements)],
            }
        )
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        self.data += packed
        return len(self.accessors) - 1

    def to_json(self):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        return [{"byteLength": len(self.data), "uri": uri}]


def paper():
    buffer = Buffer()
    times = buffer.add("SCALAR", [floats([frame / FRAMES_PER_SECOND]) for frame in range(FRAMES + 1)])
    cube_places = buffer.add("VEC3", circling(lambda sine, cosine: [0.6, 0.8 * sine, -2.2]))
    light_places = buffer.add("VEC3", circling(lambda sine, cosine: [2 * cosine, 2.0, -3 + 2 * sine]))
    sphere = {"sphere": {"radius": 0.5}}
    return {
        "asset": {"version": "2.0", "generator": "assets/scenes/paper.py"},
        "extensionsUsed": [
            "EXT_implicit_geometry",
            "KHR_lights_punctual",
            "TANDEM_display",
            "TANDEM_environment",
            "TANDEM_lights_phong",
            "TANDEM_materials_phong",
        ],
        "extensionsRequired": ["EXT_implicit_geometry"],
        "scene": 0,
        "scenes": [
            {
                "name": "paper",
                "nodes": [0, 1, 2, 3, 4, 5],
                "extensions": {
                    "TANDEM_display": {"transfer": "linear"},
                    "TANDEM_environment": {
                        "gradient": {"bottom": [1, 1, 1], "top": floats([0.5, 0.7, 1])},
                        "ambient": [1, 1, 1],
                    }
                },
                "extras": {"frames_per_second": FRAMES_PER_SECOND},
            }
        ],
        "nodes": [
            {"name": "camera", "camera": 0},
            {"name": "red sphere", "mesh": 0, "translation": floats([-1.2, 0, -3])},
            {"name": "green sphere", "mesh": 1, "translation": floats([0, 0, -3])},
            {"name": "blue sphere", "mesh": 2, "translation": floats([1.2, 0, -3])},
            {"name": "cube", "mesh": 3, "translation": floats([0.6, 0, -2.2])},
            {
                "name": "light",
                "translation": [2, 2, -3],
                "extensions": {"KHR_lights_punctual": {"light": 0}},
            },
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 2 * math.atan(1 / 1.5), "znear": 0.01}}],
        "meshes": [
            shape_mesh("red sphere", sphere, 0),
            shape_mesh("green sphere", sphere, 1),
            shape_mesh("blue sphere", sphere, 2),
            shape_mesh("cube", {"box": {"size": floats([0.6, 0.6, 0.6])}}, 3),
        ],
        "materials": [
            material("red", [0.8, 0.2, 0.2]),
            material("green", [0.2, 0.8, 0.2]),
            material("blue", [0.2, 0.2, 0.8]),
            material("yellow", [0.8, 0.8, 0.2]),
        ],
        "extensions": {
            "KHR_lights_punctual": {
                "lights": [
                    {
                        "name": "light",
                        "type": "point",
                        "extensions": {"TANDEM_lights_phong": {"falloff": False, "shadows": False}},
                    }
                ]
            }
        },
        "animations": [
            {
                "name": "circle",
                "samplers": [
                    {"input": times, "interpolation": "LINEAR", "output": cube_places},
                    {"input": times, "interpolation": "LINEAR", "output": light_places},
                ],
                "channels": [
                    {"sampler": 0, "target": {"node": 4, "path": "translation"}},
                    {"sampler": 1, "target": {"node": 5, "path": "translation"}},
                ],
            }
        ],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": buffer.to_json(),
    }


def main():
    target = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "paper.gltf")
    text = json.dumps(paper(), indent=1) + "\n"
    if target == "-":
        sys.stdout.write(text)
        return
    with open(target + ".part", "w", encoding="utf-8", newline="\n") as out:
        out.write(text)
    os.replace(target + ".part", target)


if __name__ == "__main__":
    main()
