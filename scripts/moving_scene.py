#!/usr/bin/env python3
"""Writes a glTF file in which many primitives move, to measure hierarchies that are refitted
(docs/performance/hierarchies.md).

    scripts/moving_scene.py FILE.glb spheres|triangles PRIMITIVES GROUPS STEP

In each of 16 frames, groups of spheres in one cube drift apart by STEP metres; one group alone, and sheets of triangles, turn by
STEP radians. The scenes of the page: `spheres 1000000 1 0.004`, `spheres 1000000 64 0.001`, `triangles 1000000 64 0.004` and
`spheres 10000000 64 0.0002`."""

import json
import math
import random
import struct
import sys
from array import array

FRAMES = 16
COMPONENTS = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
FLOAT, UNSIGNED_INT = 5126, 5125


class Buffer:
    """The binary part of a file, and its views and accessors."""

    def __init__(self):
        self.data, self.views, self.accessors = bytearray(), [], []

    def add(self, values, components, type_code=FLOAT):
        raw = values.tobytes()
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(raw)})
        self.data += raw
        accessor = {"bufferView": len(self.views) - 1, "componentType": type_code, "count": len(values) // components}
        accessor["type"] = COMPONENTS[components]
        if type_code == FLOAT:
            accessor["min"] = [min(values[i::components]) for i in range(components)]
            accessor["max"] = [max(values[i::components]) for i in range(components)]
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def sheet_mesh(buffer, triangles):
    side = int(math.sqrt(triangles / 2))
    positions, indices = array("f"), array("I")
    for i in range(side + 1):
        for j in range(side + 1):
            x, z = 2 * i / side - 1, 2 * j / side - 1
            positions.extend([x, 0.05 * math.sin(9 * x) * math.cos(11 * z), z])
    for i in range(side):
        for j in range(side):
            a = i * (side + 1) + j
            indices.extend([a, a + 1, a + side + 2, a, a + side + 2, a + side + 1])
    corners = buffer.add(positions, 3)
    return {"material": 0, "attributes": {"POSITION": corners}, "indices": buffer.add(indices, 1, UNSIGNED_INT)}


def sphere_mesh(spheres):
    radius = 0.006 * (1e6 / spheres) ** (1 / 3)
    return {"material": 0, "extensions": {"EXT_implicit_geometry": {"sphere": {"radius": radius}}}}


def random_axis():
    axis = [random.random() - 0.5 for _ in range(3)]
    length = math.sqrt(sum(a * a for a in axis))
    return [a / length for a in axis]


def main():
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    file, kind = sys.argv[1:3]
    count, groups, step = int(sys.argv[3]), int(sys.argv[4]), float(sys.argv[5])
    random.seed(1)
    buffer = Buffer()
    times = buffer.add(array("f", [frame / 30 for frame in range(FRAMES)]), 1)
    is_spheres = kind == "spheres"
    mesh = sphere_mesh(count) if is_spheres else sheet_mesh(buffer, count / groups)
    nodes = [{"camera": 0, "translation": [0, 0, 3.2], "name": "camera"}]
    samplers, channels = [], []
    for group in range(groups):
        node = {"mesh": 0, "name": f"group {group}"}
        if is_spheres:
            places = array("f", [2 * random.random() - 1 for _ in range(3 * (count // groups))])
            node["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": buffer.add(places, 3)}}}
        else:
            node["translation"] = [0, (2 * group + 1) / groups - 1, 0]
        axis = random_axis()
        drifts = is_spheres and groups > 1
        values = array("f")
        for frame in range(FRAMES):
            half = step * frame / 2
            if drifts:
                values.extend([a * step * frame for a in axis])
            else:
                values.extend([a * math.sin(half) for a in axis] + [math.cos(half)])
        samplers.append({"input": times, "output": buffer.add(values, 3 if drifts else 4)})
        path = "translation" if drifts else "rotation"
        channels.append({"sampler": group, "target": {"node": len(nodes), "path": path}})
        nodes.append(node)
    document = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["EXT_implicit_geometry", "EXT_mesh_gpu_instancing"] if is_spheres else [],
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": [{"primitives": [mesh]}],
        "materials": [{"doubleSided": True}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.176, "znear": 0.01}}],
        "animations": [{"samplers": samplers, "channels": channels}],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
    }
    if not document["extensionsUsed"]:
        del document["extensionsUsed"]
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(file, "wb") as out:
        out.write(struct.pack("<III", 0x46546C67, 2, 12 + 8 + len(text) + 8 + len(buffer.data)))
        out.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        out.write(struct.pack("<II", len(buffer.data), 0x004E4942) + buffer.data)


main()
