#!/usr/bin/env python3
"""Times whitted.gltf on the CPU beside the same scene in Mitsuba 3, in turns, and prints the ratio of their rates.

  scripts/versus_mitsuba.py [--render build/release/bin/tandem-render] [--tier strict] [--variant scalar_rgb]
                         [--threads N] [--size 500x450] [--spp 16] [--repetitions 3] [--pictures FOLDER] [--json FILE]

Needs a Python with the packages mitsuba and numpy (`pip install mitsuba numpy`); the llvm variants also need LLVM's
shared library (Debian: libllvm19; Mitsuba 3.9.1 aborts with those of LLVM 14 and 15). The two take turns, after a first
round that does not count. Both trace paths with next-event estimation. What differs: Mitsuba's materials have no Phong
highlights; its glass does not absorb; it ends paths after 8 vertices, Tandem after 8 reflections, 16 refractions or 4
diffuse bounces. `--pictures` writes both images,
`--json` the seconds of each round.
"""

import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time

try:
    import drjit as dr
    import mitsuba as mi
    import numpy as np
except ImportError as error:
    sys.exit(f"versus_mitsuba: {error}; install it with 'pip install mitsuba numpy'")

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def bitmap(width, height, colour_of, raw):
    picture = np.array([colour_of(i) for i in range(width * height)], dtype=np.uint8).reshape(height, width, -1)
    return {"type": "bitmap", "bitmap": mi.Bitmap(picture), "filter_type": "bilinear", "raw": raw}


def mitsuba_scene(width, height, spp):
    """The scene of assets/scenes/whitted.py."""
    sys.path.insert(0, os.path.join(ROOT, "assets", "scenes"))
    sys.argv[1:] = ["-"]
    with open(os.devnull, "w", encoding="utf-8") as null:
        out, sys.stdout = sys.stdout, null
        import whitted

        sys.stdout = out
    T = mi.ScalarTransform4f
    checker = bitmap(64, 64, lambda i: whitted.checker(i)[:3], raw=False)
    checker["to_uv"] = T().scale([8, 8, 1])
    net_alpha = bitmap(16, 16, lambda i: whitted.net(i)[3:], raw=True)
    net_alpha.update({"to_uv": T().scale([8, 4, 1]), "filter_type": "nearest"})
    ripples = bitmap(64, 64, lambda i: whitted.ripple(i)[:3], raw=True)
    glass = {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}

    def lambertian(r, g, b):
        return {"type": "diffuse", "reflectance": {"type": "rgb", "value": [r, g, b]}}

    def sphere(at, radius, bsdf, **more):
        return {"type": "sphere", "center": list(at), "radius": radius, "bsdf": bsdf, **more}

    sky = np.zeros((64, 128, 3), dtype=np.float32)
    for y in range(64):
        m = 0.5 * (math.cos(math.pi * (y + 0.5) / 64) + 1)
        sky[y, :] = [(1 - m) * a + m * b for a, b in zip((0.55, 0.5, 0.45), (0.45, 0.65, 1.0))]
    quad = {"type": "rectangle"}
    floor = T().translate([0, 0, -2]) @ T().rotate([1, 0, 0], -90) @ T().scale([6, 7, 1])
    fence = T().translate([-1.2, 0.45, -1.2]) @ T().scale([0.9, 0.45, 1])
    spot_at, spot_along = [2.4, 3.2, 2.4], [-2.3, -2.6, -2.2]
    spot_to = [a + b for a, b in zip(spot_at, spot_along)]
    return mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 8},
            "sensor": {
                "type": "thinlens",
                "to_world": T().look_at(origin=[0.1, 1.45, 5.4], target=[0.05, 0.75, 0], up=[0, 1, 0]),
                "fov": 36,
                "fov_axis": "y",
                "aperture_radius": 0.02,
                "focus_distance": 5.1,
                "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}},
                "sampler": {"type": "independent", "sample_count": spp},
            },
            "sky": {"type": "envmap", "bitmap": mi.Bitmap(sky)},
            "sun": {"type": "directional", "direction": [-0.5, -1, -0.7], "irradiance": {"type": "rgb", "value": [4.7, 4.5, 4.0]}},
            "spot": {
                "type": "spot",
                "to_world": T().look_at(origin=spot_at, target=spot_to, up=[0, 1, 0]),
                "intensity": {"type": "rgb", "value": [31, 35, 44]},
                "beam_width": 12,
                "cutoff_angle": 24,
            },
            "lamp": sphere((-2.0, 2.3, 0.6), 0.22, lambertian(0, 0, 0), emitter={"type": "area", "radiance": {"type": "rgb", "value": [12, 10, 7]}}),
            "floor": {**quad, "to_world": floor, "bsdf": {"type": "diffuse", "reflectance": checker}},
            "fence": {**quad, "to_world": fence, "bsdf": {"type": "mask", "opacity": net_alpha, "nested": {"type": "twosided", "bsdf": lambertian(0.05, 0.16, 0.05)}}},
            "ball": sphere((-0.35, 1.15, 1.0), 0.55, glass),
            "bubble": sphere((-0.35, 1.15, 1.0), 0.3, {"type": "dielectric", "int_ior": 1.0, "ext_ior": 1.5}),
            "mirror": sphere((0.75, 0.62, -0.2), 0.6, {"type": "conductor", "specular_reflectance": {"type": "rgb", "value": [0.85, 0.87, 0.9]}}),
            "clay": sphere((-1.35, 0.35, 0.1), 0.35, {"type": "normalmap", "normalmap": ripples, "bsdf": lambertian(0.65, 0.5, 0.4)}),
            "block": {"type": "cube", "to_world": T().translate([1.6, 0.36, 0.9]) @ T().rotate([0, 1, 0], 25) @ T().scale([0.25, 0.35, 0.25]), "bsdf": glass},
        }
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--render", default=os.path.join(ROOT, "build", "release", "bin", "tandem-render"))
    parser.add_argument("--tier", default="strict", help="of Tandem (docs/tiers.md)")
    parser.add_argument("--variant", default="scalar_rgb")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), help="of each; default: all of the machine")
    parser.add_argument("--size", default="500x450")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--pictures")
    parser.add_argument("--json", help="for the seconds of each round")
    options = parser.parse_args()
    width, height = (int(n) for n in options.size.split("x"))
    if not os.access(options.render, os.X_OK):
        sys.exit(f"versus_mitsuba: there is no program {options.render}; build it, or name it with --render")
    try:
        mi.set_variant(options.variant)
        dr.set_thread_count(options.threads)
        mi.Float(0) + 1  # llvm variants load LLVM only now
    except (ImportError, RuntimeError) as error:
        sys.exit(f"versus_mitsuba: Mitsuba cannot run {options.variant} here: {error}")
    scene = mitsuba_scene(width, height, options.spp)
    samples = width * height * options.spp
    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(options.pictures or folder, "tandem.png")
        command = [options.render, os.path.join(ROOT, "assets", "scenes", "whitted.gltf"), "-o", picture, "--size", options.size]
        command += ["--spp", str(options.spp), "--sampler", "random", "--backend", "cpu", "--tier", options.tier, "--exposure", "0", "--threads", str(options.threads), "--force", "--quiet", "--json", "-"]
        for turn in range(-1, options.repetitions):
            frame = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["frames"][0]
            start = time.perf_counter()
            image = mi.render(scene, spp=options.spp)
            np.array(image)  # waits
            seconds = time.perf_counter() - start
            if turn < 0:  # warms up: an llvm variant compiles its kernel
                continue
            ours.append(frame["seconds"]["render"])
            theirs.append(seconds)
    if options.pictures:
        mi.util.write_bitmap(os.path.join(options.pictures, "mitsuba.png"), image)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({"tandem": ours, "mitsuba": theirs, "samples": samples, "version": mi.__version__, "variant": frame["variant"]}, file)
    mine, other = samples / statistics.median(ours), samples / statistics.median(theirs)
    print(f"Tandem, {options.tier}, {frame['variant']}: {mine / 1e6:.3f} M samples/s")
    print(f"Mitsuba {mi.__version__}, {options.variant}: {other / 1e6:.3f} M samples/s")
    print(f"ratio {mine / other:.2f}, medians of {options.repetitions}, {width} x {height} x {options.spp} samples")


if __name__ == "__main__":
    main()
