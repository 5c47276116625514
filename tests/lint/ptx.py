#!/usr/bin/env python3
"""Compiles the device code to PTX and looks for approximations.

Fails on .approx, .full and .ftz in the kernels of the exact tiers, and on any single-precision fma: the source writes fma
in double, and in single precision only in loose_multiply_add(), which is switched off here with the rough reciprocals; with
--fmad=false the compiler adds none. tests/lint/device_probe.cu shows that it adds none; the kernels are compiled without the
optimiser, to save time. In the render kernels that the build has linked these functions are at work, and nothing else.
The tier fast is compiled with the flags of its own, and must have them. Needs nvcc, no GPU.

usage: ptx.py ROOT BUILD NVCC
"""

import collections
import pathlib
import re
import subprocess
import sys
import tempfile

from lint import FAST_KERNEL, FAST_TIER, Report

APPROXIMATE = r"\w+(?:\.\w+)*\.(?:approx|full|ftz)(?:\.\w+)*"
ROUGH = r"r(?:cp|sqrt)\.approx\.ftz\.f(?:32|64)"  # those of math/rough.h


def instructions(pattern):
    return re.compile(rf"^\s*(?:@!?%p\d+\s+)?({pattern})\b", re.M)


# Exact operations; the compiler's own integer arithmetic uses .approx nowhere.
FORBIDDEN = instructions(rf"{APPROXIMATE}|fma\.r[nzmp]\.f32")
FORBIDDEN_IN_BUILD = instructions(rf"(?!{ROUGH}\b){APPROXIMATE}")


def units_of(source):
    """The ways to compile a source: with which macros. As in cuda/CMakeLists.txt, but each piece of the source once: the
    linked kernel in strict alone, for long paths in a hierarchy and short ones among few primitives; of kernels that trace
    rays the nearest hits of each tier, and the other queries of strict."""
    if source.name == "compiled_facts.cu":
        return []  # numbers
    if source.name == "trace.cu":
        asked = [("nearest", tier) for tier in ("strict", "precise", "fast")]
        asked += [(ask, "strict") for ask in ("nearest_from_surface", "occluded")]
        return [(source, ["-DTANDEM_SHORT_PATHS=1", f"-DTANDEM_TRACE_ASK={ask}", f"-DTANDEM_TRACE_TIER={tier}"])
                for ask, tier in asked]
    if source.name == "trace_instanced.cu":
        return [(source, ["-DTANDEM_SHORT_PATHS=1", f"-DTANDEM_TRACE_TIER={tier}"]) for tier in ("strict", "precise")]
    if source.name == "first_hits.cu":
        tracers = [("with_tracer", tier) for tier in ("strict", "precise")]
        tracers += [("with_instanced_tracer", tier) for tier in ("strict", "precise")]
        return [(source, [f"-DTANDEM_FIRST_HITS_TIER={tier}", "-DTANDEM_FIRST_HITS_NAME=first_hits_here",
                          f"-DTANDEM_FIRST_HITS_TRACERS={with_tracers}"]) for with_tracers, tier in tracers]
    if source.name != "linked_kernel.cu":
        return [(source, ["-DTANDEM_SHORT_PATHS=1"])]
    linked = [("DeferringBvhTracer", []), ("ConstantMemoryTracer", ["-DTANDEM_SHORT_PATHS=1"])]
    return [(source, ["-DTANDEM_LINKED_TIER=strict", f"-DTANDEM_LINKED_TRACER={tracer}", *short]) for tracer, short in linked]


def main():
    root, build, nvcc = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    report = Report()

    def forbid(pattern, text, shown):
        for instruction, count in collections.Counter(pattern.findall(text)).items():
            report.add(shown, f"{count} x {instruction} in the PTX")

    units = [unit for source in sorted((root / "cuda").glob("*.cu")) for unit in units_of(source)]
    units.append((root / "tests/lint/device_probe.cu", []))
    for source, defines in units:
        name = source.relative_to(root).as_posix()
        shown = " ".join([name, *defines])
        with tempfile.TemporaryDirectory() as folder:
            ptx = pathlib.Path(folder, "out.ptx")
            fast = FAST_TIER.match(name) or FAST_KERNEL.search(shown)
            exact_flags = ["--fmad=false", "--ftz=false", "--prec-div=true", "--prec-sqrt=true"]
            if name.startswith("cuda/"):
                exact_flags += ["-Xcicc", "-O0"]
            result = subprocess.run(
                [nvcc, "-ptx", "-std=c++20", "-arch=compute_75", "-rdc=true", "-DTANDEM_NO_LOOSE_FMA", *defines,
                 *(["--use_fast_math"] if fast else exact_flags), "-Xcompiler", "-ffp-contract=off", f"-I{root / 'lib'}", f"-I{root}", str(source), "-o", str(ptx)],
                capture_output=True, text=True)
            if result.returncode:
                report.add(shown, f"nvcc fails: {result.stderr.strip()[:2000]}")
                continue
            text = ptx.read_text()
        if fast:
            if "fma.rn.ftz.f32" not in text or "sqrt.approx.ftz.f32" not in text:
                report.add(shown, "does not contract or approximate, which is what the tier fast is for")
            print(f"{shown}: {len(re.findall(r'[.]approx', text))} approximations")
            continue
        forbid(FORBIDDEN, text, shown)
        print(f"{shown}: {len(re.findall(r'fma.rn.f64', text))} written fma.rn.f64")
    linked = [path for tier in ("strict", "precise") for path in sorted((build / "cuda").glob(f"compiled_*_{tier}.ptx"))]
    for path in linked:
        forbid(FORBIDDEN_IN_BUILD, path.read_text(), path.name)
    report.finish(f"{len(units)} compilations, {len(linked)} linked kernels")


main()
