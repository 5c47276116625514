#!/usr/bin/env python3
"""Writes flip_reference.def: what the package flip-evaluator, by authors of the paper, says of the pairs of pictures
that flip_test.cpp generates by the same formulas. Needs numpy and flip-evaluator.

Usage: flip_reference.py > flip_reference.def"""

import importlib.metadata

import flip_evaluator
import numpy

WIDTH, HEIGHT = 48, 40
PIXELS = ((0, 0), (12, 16), (25, 20), (37, 9), (47, 39))


def stripes(x, y, shift):
    return [(3 * x + 5 * y + 40 * channel + shift) % 256 for channel in range(3)]


def checks(x, y, level):
    return [255 * ((x // 4 + y // 4) % 2) if level < 0 else level] * 3


def disc(x, y, centre):
    within = (x - centre) ** 2 + (y - 16) ** 2 < 100
    return (230, 40, 30) if within else (20, 60 + y, 180)


def picture(colour, parameter):
    levels = [[colour(x, y, parameter) for x in range(WIDTH)] for y in range(HEIGHT)]
    return numpy.array(levels, dtype=numpy.float32) / numpy.float32(255)


def main():
    version = importlib.metadata.version("flip-evaluator")
    print(f"// FLIP_REFERENCE(name, pixels per degree, mean, errors at five pixels): flip_reference.py, flip-evaluator {version}")
    for name, colour, first, second in (("stripes", stripes, 0, 24), ("checks", checks, -1, 128), ("disc", disc, 20, 22)):
        for density in (67, 30):
            errors, mean, _ = flip_evaluator.evaluate(
                picture(colour, first), picture(colour, second), "LDR", inputsRGB=True, applyMagma=False,
                parameters={"ppd": float(density)})
            at = ", ".join(f"{float(numpy.squeeze(errors)[y, x]):.7g}" for x, y in PIXELS)
            print(f"FLIP_REFERENCE({name}, {density}, {mean:.7g}, {at})")


main()
