#!/usr/bin/env python3
"""Compiles the device code to PTX and looks for approximations.

Fails on .approx, .full and .ftz. Counts fma: with --fmad=false the compiler adds none, so each stems from a
multiply_add (double) or a loose_multiply_add (float, in what only proposes candidates). Needs nvcc, no GPU.

usage: ptx.py ROOT BUILD NVCC
"""

import collections
import pathlib
import re
import subprocess
import sys
import tempfile

from lint import Report

FORBIDDEN = re.compile(r"^\s*(?:@!?%p\d+\s+)?((?:\w+)(?:\.\w+)*\.(?:approx|full|ftz)(?:\.\w+)*)\b", re.M)


def main():
    root, build, nvcc = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    report = Report()
    sources = sorted((root / "cuda").glob("*.cu")) + [root / "tests/lint/device_probe.cu"]
    for source in sources:
        with tempfile.TemporaryDirectory() as folder:
            ptx = pathlib.Path(folder, "out.ptx")
            result = subprocess.run(
                [nvcc, "-ptx", "-std=c++20", "-arch=compute_75", "--fmad=false", "--ftz=false", "--prec-div=true",
                 "--prec-sqrt=true", "-Xcompiler", "-ffp-contract=off", f"-I{build / 'include'}",
                 f"-I{root}", str(source), "-o", str(ptx)],
                capture_output=True, text=True)
            name = source.relative_to(root).as_posix()
            if result.returncode:
                report.add(name, f"nvcc fails: {result.stderr.strip()[:2000]}")
                continue
            text = ptx.read_text()
        for instruction, count in collections.Counter(FORBIDDEN.findall(text)).items():
            report.add(name, f"{count} x {instruction} in the PTX")
        counts = {width: text.count(f"fma.rn.{width} ") for width in ("f64", "f32")}
        print(f"{name}: written fma.rn: {counts['f64']} f64, {counts['f32']} f32")
    report.finish(f"{len(sources)} files")


main()
