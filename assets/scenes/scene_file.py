"""What the scripts beside it have in common: a glTF file put together from Python, with the extensions of
docs/scene-format.md."""

import json
import math
import os
import struct
import sys


def float32(value):
    """The nearest float, as a Python number: JSON then holds exactly what Tandem keeps."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


def floats(values):
    return [float32(value) for value in values]


def turned(axis, degrees):
    """A rotation as glTF has it: x, y, z, w."""
    half = math.radians(degrees) / 2
    return [component * math.sin(half) for component in axis] + [math.cos(half)]


class SceneFile:
    """A scene of spheres, boxes, lights and one camera."""

    def __init__(self, name, script, bottom=(1, 1, 1), top=(0.5, 0.7, 1), ambient=(1, 1, 1)):
        environment = {"gradient": {"bottom": floats(bottom), "top": floats(top)}, "ambient": floats(ambient)}
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

    def node(self, name, at=(0, 0, 0), rotation=None, scale=None, **carries):
        node = {"name": name, "translation": floats(at), **carries}
        if rotation is not None:
            node["rotation"] = rotation
        if scale is not None:
            node["scale"] = floats(scale)
        self.json["scenes"][0]["nodes"].append(self._add("nodes", node))
        return node

    def material(self, name, diffuse=(0, 0, 0), ambient=None, specular=(0, 0, 0), shininess=32, mirror=None):
        """Phong's model; the ambient reflectance is a tenth of the diffuse one if it is not given."""
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
