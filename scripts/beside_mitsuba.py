#!/usr/bin/env python3
"""Renders a glTF file in Tandem and in Mitsuba 3 with one camera, and puts the images side by side.

  scripts/beside_mitsuba.py FILE.gltf [-o beside.png] [--env PICTURE.hdr] [--render build/release/bin/tandem-render]
                            [--size 500x450] [--spp 256] [--from X,Y,Z --to X,Y,Z] [--yfov 40] [--metals]

Needs a Python with the packages mitsuba, numpy and pillow. Materials become Mitsuba's `principled`. Metals have
the same model in both: GGX with alpha = roughness^2 and Schlick's approximation. Dielectrics do not: `principled` has
Disney's diffuse lobe, Tandem has Lambert's under a dielectric interface. `--metals` sets every metallic factor to 1 and
removes the metallic-roughness textures, so that the models are the same. Both simulate indirect light. The script
prints the mean of each channel over the pixels that show the object, and their ratio.
"""

import argparse
import base64
import json
import math
import os
import struct
import subprocess
import sys
import tempfile

try:
    import mitsuba as mi
    import numpy as np
    from PIL import Image
except ImportError as error:
    sys.exit(f"beside_mitsuba: {error}; install it with 'pip install mitsuba numpy pillow'")

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Gltf:
    """The compared parts of a file: triangles, metallic-roughness materials, their images."""

    def __init__(self, path):
        self.folder = os.path.dirname(os.path.abspath(path))
        with open(path, "rb") as file:
            data = file.read()
        self.chunk = b""
        if data[:4] == b"glTF":
            length = struct.unpack("<I", data[12:16])[0]
            self.json = json.loads(data[20:20 + length])
            self.chunk = data[28 + length:]
        else:
            self.json = json.loads(data)
        self.buffers = [self.bytes_of(buffer.get("uri")) for buffer in self.json.get("buffers", [])]

    def bytes_of(self, uri):
        if uri is None:
            return self.chunk
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        with open(os.path.join(self.folder, uri), "rb") as file:
            return file.read()

    def view(self, index):
        view = self.json["bufferViews"][index]
        start = view.get("byteOffset", 0)
        return self.buffers[view["buffer"]][start:start + view["byteLength"]], view.get("byteStride", 0)

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        data, stride = self.view(accessor["bufferView"])
        kind, width = np.dtype(TYPES[accessor["componentType"]]), WIDTHS[accessor["type"]]
        stride = stride or kind.itemsize * width
        return np.ndarray((accessor["count"], width), kind, data, accessor.get("byteOffset", 0), (stride, kind.itemsize))

    def image(self, texture):
        image = self.json["images"][self.json["textures"][texture]["source"]]
        data = self.view(image["bufferView"])[0] if "bufferView" in image else self.bytes_of(image["uri"])
        with tempfile.NamedTemporaryFile() as file:
            file.write(data)
            file.flush()
            return np.array(Image.open(file.name).convert("RGB"))

    def placed_meshes(self):
        def walk(index, world):
            node = self.json["nodes"][index]
            world = world @ matrix_of(node)
            if "mesh" in node:
                for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                    yield primitive, world
            for child in node.get("children", []):
                yield from walk(child, world)

        for root in self.json["scenes"][self.json.get("scene", 0)]["nodes"]:
            yield from walk(root, np.eye(4))


def matrix_of(node):
    if "matrix" in node:
        return np.array(node["matrix"]).reshape(4, 4).T
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    result = np.eye(4)
    result[:3, :3] = rotation * np.array(node.get("scale", [1, 1, 1]))
    result[:3, 3] = node.get("translation", [0, 0, 0])
    return result


def bitmap(pixels, raw):
    return {"type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(pixels)), "raw": raw}


def bsdf_of(gltf, material):
    pbr = material.get("pbrMetallicRoughness", {})
    bsdf = {"type": "principled", "base_color": {"type": "rgb", "value": pbr.get("baseColorFactor", [1, 1, 1, 1])[:3]},
            "metallic": pbr.get("metallicFactor", 1.0), "roughness": max(pbr.get("roughnessFactor", 1.0), 0.01),
            "eta": material.get("extensions", {}).get("KHR_materials_ior", {}).get("ior", 1.5)}
    if "baseColorTexture" in pbr:
        bsdf["base_color"] = bitmap(gltf.image(pbr["baseColorTexture"]["index"]), raw=False)
    if "metallicRoughnessTexture" in pbr:
        pixels = gltf.image(pbr["metallicRoughnessTexture"]["index"])
        bsdf["metallic"] = bitmap(pixels[:, :, 2:], raw=True)
        bsdf["roughness"] = bitmap(pixels[:, :, 1:2], raw=True)
    if "normalTexture" in material:
        pixels = gltf.image(material["normalTexture"]["index"])
        bsdf = {"type": "normalmap", "normalmap": bitmap(pixels, raw=True), "bsdf": bsdf}
    return {"type": "twosided", "bsdf": bsdf}


def shape_of(gltf, primitive, world, bsdf, emission):
    attributes = {name: gltf.accessor(index).astype(np.float64) for name, index in primitive["attributes"].items()
                  if name in ("POSITION", "NORMAL", "TEXCOORD_0")}
    vertices = attributes["POSITION"] @ world[:3, :3].T + world[:3, 3]
    indices = gltf.accessor(primitive["indices"]).reshape(-1) if "indices" in primitive else np.arange(len(vertices))
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(bsdf)
    if any(emission):
        properties["emitter"] = mi.load_dict({"type": "area", "radiance": {"type": "rgb", "value": emission}})
    mesh = mi.Mesh("mesh", len(vertices), len(indices) // 3, has_vertex_normals="NORMAL" in attributes,
                   has_vertex_texcoords="TEXCOORD_0" in attributes, props=properties)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = vertices.astype(np.float32).ravel()
    parameters["faces"] = indices.astype(np.uint32).ravel()
    if "NORMAL" in attributes:
        normals = attributes["NORMAL"] @ np.linalg.inv(world[:3, :3])
        parameters["vertex_normals"] = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype(np.float32).ravel()
    if "TEXCOORD_0" in attributes:
        parameters["vertex_texcoords"] = attributes["TEXCOORD_0"].astype(np.float32).ravel()
    parameters.update()
    return mesh, vertices


def make_metals(gltf):
    for material in gltf.json.get("materials", []):
        pbr = material.setdefault("pbrMetallicRoughness", {})
        pbr["metallicFactor"] = 1.0
        pbr.setdefault("roughnessFactor", 0.3)
        pbr.pop("metallicRoughnessTexture", None)
        material.pop("alphaMode", None)


def write_with_camera(gltf, path, eye, target, yfov):
    """A copy of the file with embedded buffers and images, and a camera."""
    forward = np.subtract(target, eye) / np.linalg.norm(np.subtract(target, eye))
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([right, np.cross(right, forward), -forward]).T
    matrix[:3, 3] = eye
    written = json.loads(json.dumps(gltf.json))
    for buffer, data in zip(written.get("buffers", []), gltf.buffers):
        buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data[:buffer["byteLength"]]).decode()
    for image in written.get("images", []):
        if "uri" in image and not image["uri"].startswith("data:"):
            kind = "png" if image["uri"].endswith("png") else "jpeg"
            image["uri"] = f"data:image/{kind};base64," + base64.b64encode(gltf.bytes_of(image["uri"])).decode()
    written["cameras"] = [{"type": "perspective", "perspective": {"yfov": math.radians(yfov), "znear": 0.01}}]
    written["nodes"].append({"camera": 0, "matrix": matrix.T.ravel().tolist()})
    written["scenes"][written.get("scene", 0)]["nodes"].append(len(written["nodes"]) - 1)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(written, file)


def read_pfm(path):
    with open(path, "rb") as file:
        channels = 3 if file.readline() == b"PF\n" else 1
        width, height = map(int, file.readline().split())
        file.readline()
        return np.frombuffer(file.read(), "<f4").reshape(height, width, channels)[::-1]


def to_srgb(linear):
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("-o", "--output", default="beside.png")
    parser.add_argument("--env")
    parser.add_argument("--render", default=os.path.join(ROOT, "build/release/bin/tandem-render"))
    parser.add_argument("--size", default="500x450")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--from", dest="eye")
    parser.add_argument("--to", dest="target")
    parser.add_argument("--yfov", type=float, default=40)
    parser.add_argument("--metals", action="store_true")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    mi.set_variant("llvm_ad_rgb" if "llvm_ad_rgb" in mi.variants() else "scalar_rgb")

    gltf = Gltf(options.file)
    if options.metals:
        make_metals(gltf)
    scene = {"type": "scene", "integrator": {"type": "path", "max_depth": 6, "hide_emitters": False}}
    points = []
    for number, (primitive, world) in enumerate(gltf.placed_meshes()):
        material = gltf.json["materials"][primitive["material"]] if "material" in primitive else {}
        strength = material.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
        emission = [strength * x for x in material.get("emissiveFactor", [0, 0, 0])]
        scene[f"shape{number}"], vertices = shape_of(gltf, primitive, world, bsdf_of(gltf, material), emission)
        points.append(vertices)
    lower, upper = np.concatenate(points).min(0), np.concatenate(points).max(0)
    centre = (lower + upper) / 2
    target = [float(x) for x in options.target.split(",")] if options.target else centre.tolist()
    distance = np.linalg.norm(upper - lower) / 2 / math.sin(math.radians(options.yfov / 2))
    eye = [float(x) for x in options.eye.split(",")] if options.eye else (centre + [0, 0, distance]).tolist()
    T = mi.ScalarTransform4f
    if options.env:
        # the centre of our pictures is seen along -z, that of Mitsuba's along +z
        scene["env"] = {"type": "envmap", "filename": options.env, "to_world": T().rotate([0, 1, 0], 180)}
    scene["sensor"] = {
        "type": "perspective", "fov": options.yfov, "fov_axis": "y",
        "to_world": T().look_at(origin=eye, target=target, up=[0, 1, 0]),
        "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
        "sampler": {"type": "independent", "sample_count": options.spp}}
    theirs = np.array(mi.render(mi.load_dict(scene), spp=options.spp))

    with tempfile.TemporaryDirectory() as folder:
        file, film = os.path.join(folder, "scene.gltf"), os.path.join(folder, "film.pfm")
        write_with_camera(gltf, file, eye, target, options.yfov)
        command = [options.render, file, "-o", film, "--size", options.size, "--spp", str(options.spp), "--sampler", "random", "--indirect",
                   "--light", "none", "--limits", "5,5,5", "--aov", "depth"]
        subprocess.run(command + (["--env", options.env] if options.env else []), check=True)
        ours = read_pfm(film)
        is_hit = np.isfinite(read_pfm(os.path.join(folder, "film.depth.pfm"))[:, :, 0])

    for channel, name in enumerate(("red", "green", "blue")):
        a, b = ours[is_hit, channel].mean(), theirs[is_hit, channel].mean()
        print(f"{name}: Tandem {a:.5f}, Mitsuba {b:.5f}, ratio {a / b:.4f}")
    picture = to_srgb(np.concatenate([ours, theirs], axis=1))
    Image.fromarray((picture * 255 + 0.5).astype(np.uint8)).save(options.output)
    print(f"{options.output}: Tandem on the left, Mitsuba on the right")


main()
