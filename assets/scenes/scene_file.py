"""What the scripts beside it have in common: a glTF file put together from Python, with the extensions of
docs/scene-format.md."""

import base64
import json
import math
import os
import struct
import sys
import zlib


def float32(value):
    """The nearest float, as a Python number: JSON then holds exactly what Tandem keeps."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


def floats(values):
    return [float32(value) for value in values]


def turned(axis, degrees):
    """A rotation as glTF has it: x, y, z, w."""
    half = math.radians(degrees) / 2
    return [component * math.sin(half) for component in axis] + [math.cos(half)]


def aimed(direction):
    """The rotation that turns -z, where lights shine and cameras look, towards `direction`."""
    length = math.sqrt(sum(c * c for c in direction))
    x, y, z = (c / length for c in direction)
    w = 1 - z  # (cross(-z, d), 1 + dot(-z, d)) is the quaternion, but for its length; not for direction +z
    norm = math.sqrt(x * x + y * y + w * w)
    return [y / norm, -x / norm, 0, w / norm]


def png(width, height, pixels):
    """The bytes of a PNG file. `pixels`: red, green, blue and alpha, 0 to 255, row by row from the top."""

    pixels = list(pixels)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(
        b"\0" + b"".join(bytes(pixel) for pixel in pixels[y * width : (y + 1) * width]) for y in range(height)
    )
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


class SceneFile:
    """A scene of spheres, boxes, lights and one camera."""

    def __init__(self, name, script, bottom=(1, 1, 1), top=(0.5, 0.7, 1), ambient=(1, 1, 1), **more):
        """`more`: further members of TANDEM_environment."""
        environment = {**more, "gradient": {"bottom": floats(bottom), "top": floats(top)}, "ambient": floats(ambient)}
        self.json = {
            "asset": {"version": "2.0", "generator": f"assets/scenes/{os.path.basename(script)}"},
            "extensionsUsed": ["TANDEM_environment"],
            "scene": 0,
            "scenes": [{"name": name, "nodes": [], "extensions": {"TANDEM_environment": environment}}],
            "nodes": [],
        }

    def _add(self, array, element):
        self.json.setdefault(array, []).append(element)
        return len(self.json[array]) - 1

    def _use(self, extension):
        if extension not in self.json["extensionsUsed"]:
            self.json["extensionsUsed"] = sorted(self.json["extensionsUsed"] + [extension])

    def extend(self, owner, extension, content):
        self._use(extension)
        owner.setdefault("extensions", {})[extension] = content

    def node(self, name, at=(0, 0, 0), rotation=None, scale=None, parent=None, **carries):
        """`parent`: the node that it hangs on."""
        node = {"name": name, "translation": floats(at), **carries}
        if rotation is not None:
            node["rotation"] = rotation
        if scale is not None:
            node["scale"] = floats(scale)
        siblings = self.json["scenes"][0]["nodes"] if parent is None else parent.setdefault("children", [])
        siblings.append(self._add("nodes", node))
        return node

    def _accessor(self, kind, code, component, values, bounds=False):
        """`code`: of struct; `component`: the same, as glTF counts types; `bounds`: also the least and the most."""
        packed = b"".join(struct.pack("<" + code * len(value), *value) for value in values)
        uri = "data:application/octet-stream;base64," + base64.b64encode(packed).decode()
        buffer = self._add("buffers", {"byteLength": len(packed), "uri": uri})
        view = self._add("bufferViews", {"buffer": buffer, "byteLength": len(packed)})
        described = {"bufferView": view, "componentType": component, "count": len(values), "type": kind}
        if bounds:
            columns = list(zip(*([float32(x) for x in value] for value in values)))
            described.update({"min": [min(c) for c in columns], "max": [max(c) for c in columns]})
        return self._add("accessors", described)

    def animate(self, node, path, times, values, interpolation="LINEAR"):
        """`path`: translation, rotation or scale. Of cubic splines three values a key: in-tangent, value, out-tangent."""
        if "animations" not in self.json:
            self.json["animations"] = [{"samplers": [], "channels": []}]
        animation = self.json["animations"][0]
        sampler = {
            "input": self._accessor("SCALAR", "f", 5126, [(time,) for time in times], True),
            "output": self._accessor("VEC4" if path == "rotation" else "VEC3", "f", 5126, values),
            "interpolation": interpolation,
        }
        index = next(i for i, other in enumerate(self.json["nodes"]) if other is node)
        target = {"node": index, "path": path}
        animation["channels"].append({"sampler": len(animation["samplers"]), "target": target})
        animation["samplers"].append(sampler)

    def expose(self, stops):
        """How much brighter 8-bit pictures of the scene are."""
        self.extend(self.json["scenes"][0], "TANDEM_display", {"exposure": stops})

    def frame_rate(self, frames_per_second):
        self.json["scenes"][0]["extras"] = {"frames_per_second": frames_per_second}

    def _texture(self, picture):
        """`picture`: the bytes of a PNG file."""
        self.json.setdefault("samplers", [{"magFilter": 9729, "minFilter": 9729}])
        uri = "data:image/png;base64," + base64.b64encode(picture).decode()
        image = self._add("images", {"mimeType": "image/png", "uri": uri})
        return {"index": self._add("textures", {"sampler": 0, "source": image})}

    def material(
        self,
        name,
        diffuse=(0, 0, 0),
        ambient=None,
        specular=(0, 0, 0),
        shininess=32,
        mirror=None,
        emission=None,
        texture=None,
        normal_map=None,
        cut_out=False,
    ):
        """Phong's model; the ambient reflectance is a tenth of the diffuse one if it is not given. `emission`: RGB
        radiance; `texture`, `normal_map`: PNG files; `cut_out`: by the texture's alpha."""
        phong = {
            "ambient": floats(ambient if ambient is not None else [0.1 * value for value in diffuse]),
            "diffuse": floats(diffuse),
            "specular": floats(specular),
            "shininess": shininess,
        }
        if mirror is not None:
            phong["mirror"] = floats(mirror)
        material = {"name": name, "pbrMetallicRoughness": {"baseColorFactor": floats(diffuse) + [1]}}
        self.extend(material, "TANDEM_materials_phong", phong)
        if emission is not None:
            strength = max(emission)
            material["emissiveFactor"] = floats(value / strength for value in emission)
            self.extend(material, "KHR_materials_emissive_strength", {"emissiveStrength": strength})
        if texture is not None:
            material["pbrMetallicRoughness"]["baseColorTexture"] = self._texture(texture)
        if normal_map is not None:
            material["normalTexture"] = self._texture(normal_map)
        if cut_out:
            material["alphaMode"] = "MASK"
        return self._add("materials", material)

    def microfacets(self, name, colour, metallic, roughness, texture=None, ior=None):
        """glTF's metallic-roughness. `texture`: a PNG file whose green multiplies the roughness, and blue the metal."""
        factors = {"baseColorFactor": floats(colour) + [1], "metallicFactor": metallic, "roughnessFactor": roughness}
        material = {"name": name, "pbrMetallicRoughness": factors}
        if texture is not None:
            factors["metallicRoughnessTexture"] = self._texture(texture)
        if ior is not None:
            self.extend(material, "KHR_materials_ior", {"ior": ior})
        return self._add("materials", material)

    def glass(self, name, ior, colour=None, distance=None, priority=0, specular=(0.6, 0.6, 0.6), shininess=300):
        """A dielectric, of the given colour after `distance` metres; clear without one."""
        index = self.material(name, specular=specular, shininess=shininess)
        material = self.json["materials"][index]
        volume = {"thicknessFactor": 1}
        if colour is not None:
            volume.update({"attenuationDistance": distance, "attenuationColor": floats(colour)})
        self.extend(material, "KHR_materials_transmission", {"transmissionFactor": 1})
        self.extend(material, "KHR_materials_ior", {"ior": ior})
        self.extend(material, "KHR_materials_volume", volume)
        self.extend(material, "TANDEM_materials_dielectric", {"priority": priority})
        return index

    def _shape(self, name, shape, material):
        """Bodies that are alike share a mesh."""
        for index, mesh in enumerate(self.json.get("meshes", [])):
            primitive = mesh["primitives"][0]
            if "attributes" in primitive:
                continue
            if primitive["material"] == material and primitive["extensions"]["EXT_implicit_geometry"] == shape:
                return index
        primitive = {"material": material}
        self.extend(primitive, "EXT_implicit_geometry", shape)
        self.json["extensionsRequired"] = ["EXT_implicit_geometry"]
        return self._add("meshes", {"name": name, "primitives": [primitive]})

    def sphere(self, name, material, radius, at, **placed):
        return self.node(name, at, mesh=self._shape(name, {"sphere": {"radius": float32(radius)}}, material), **placed)

    def box(self, name, material, size, at, **placed):
        return self.node(name, at, mesh=self._shape(name, {"box": {"size": floats(size)}}, material), **placed)

    def mesh(self, name, material, corners, triangles, at, texcoords=None, double_sided=False, **placed):
        """Triangles between corners, three numbers of corners each."""
        if double_sided:
            self.json["materials"][material]["doubleSided"] = True

        attributes = {"POSITION": self._accessor("VEC3", "f", 5126, corners, True)}
        if texcoords is not None:
            attributes["TEXCOORD_0"] = self._accessor("VEC2", "f", 5126, texcoords)
        indices = self._accessor("SCALAR", "H", 5123, [(i,) for i in triangles])
        primitive = {"attributes": attributes, "indices": indices, "material": material}
        return self.node(name, at, mesh=self._add("meshes", {"name": name, "primitives": [primitive]}), **placed)

    def lens(self, camera, aperture_radius, focus_distance, blades=0, rotation=0.0):
        """`camera`: the node that camera() has made."""
        lens = {"apertureRadius": aperture_radius, "focusDistance": focus_distance, "blades": blades, "rotation": rotation}
        self.extend(self.json["cameras"][camera["camera"]], "TANDEM_camera_lens", lens)

    def shutter(self, camera, opens, closes, instants=None):
        """Seconds after the time of a frame. `camera`: the node that camera() has made."""
        shutter = {"open": opens, "close": closes}
        if instants is not None:
            shutter["instants"] = instants
        self.extend(self.json["cameras"][camera["camera"]], "TANDEM_camera_shutter", shutter)

    def camera(self, at, look_at, degrees):
        """The whole vertical angle; the camera stands upright."""
        perspective = {"yfov": math.radians(degrees), "znear": 0.01}
        x, y, z = (b - a for a, b in zip(at, look_at))
        heading, pitch = math.atan2(-x, -z), math.atan2(y, math.hypot(x, z))
        # heading about y, then pitch about x: the product of the two quaternions
        cy, sy, cx, sx = (f(angle / 2) for angle in (heading, pitch) for f in (math.cos, math.sin))
        rotation = [cy * sx, sy * cx, -sy * sx, cy * cx]
        index = self._add("cameras", {"type": "perspective", "perspective": perspective})
        return self.node("camera", at, rotation=rotation, camera=index)

    def light(self, name, kind, at=(0, 0, 0), intensity=1, colour=(1, 1, 1), rotation=None, cone=None, phong=None):
        """`cone`: inner and outer angle of a spot, in degrees. `phong`: the content of TANDEM_lights_phong."""
        light = {"name": name, "type": kind, "intensity": float32(intensity), "color": floats(colour)}
        if cone is not None:
            light["spot"] = dict(zip(("innerConeAngle", "outerConeAngle"), map(math.radians, cone)))
        if phong is not None:
            self.extend(light, "TANDEM_lights_phong", phong)
        self._use("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(light)
        node = self.node(name, at, rotation=rotation)
        node["extensions"] = {"KHR_lights_punctual": {"light": len(lights) - 1}}
        return node

    def write(self, script):
        """To the file that the command line names, - for standard output, or the .gltf beside `script`."""
        target = sys.argv[1] if len(sys.argv) > 1 else os.path.splitext(os.path.abspath(script))[0] + ".gltf"
        text = json.dumps(self.json, indent=1) + "\n"
        if target == "-":
            sys.stdout.write(text)
        else:
            with open(target, "w", encoding="utf-8") as file:
                file.write(text)
