#!/usr/bin/env python3
"""Compiles the device code to PTX and looks for approximations.

Fails on .approx, .full and .ftz in the kernels of the exact tiers, and on any single-precision fma: the source writes fma
in double, and in single precision only in loose_multiply_add(), which is switched off here with the rough reciprocals; with
--fmad=false the compiler adds none. tests/lint/device_probe.cu shows that it adds none; the kernels are compiled without the
optimiser, to save time. In the render kernels that the build has linked these functions are at work, and nothing else.
Fails on the test of all primitives after a full stack, which is for hosts.
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
# The test of all primitives after a full stack, which is for hosts alone (lib/tandem/kernel/traversal/bvh_tracer.h).
TRIES_ALL = re.compile(r"^(?:\.weak )?\.func.*(bvh_detail7try_all)", re.M)


def units_of(source):
    """The ways to compile a source: with which macros. The linked kernel in strict alone, for long paths in a hierarchy and
    short ones among few primitives."""
    if source.name in ("compiled_facts.cu", "first_hits.cu", "trace_instanced.cu"):
        return []  # numbers; in exact_kernels()
    if source.name == "trace.cu":
        return [(source, ["-DTANDEM_SHORT_PATHS=1", "-DTANDEM_TRACE_TIER=fast"])]
    if source.name != "linked_kernel.cu":
        return [(source, ["-DTANDEM_SHORT_PATHS=1"])]
    linked = [("DeferringBvhTracer", []), ("ConstantMemoryTracer", ["-DTANDEM_SHORT_PATHS=1"])]
    return [(source, ["-DTANDEM_LINKED_TIER=strict", f"-DTANDEM_LINKED_TRACER={tracer}", *short]) for tracer, short in linked]


def exact_kernels(tier):
    """The kernels of a tier that trace rays and find first hits, as one source: compiled one by one, as the build does, they
    take twice as long."""
    lines = [f"#define TANDEM_{name}" for name in ("SHORT_PATHS 1", f"TRACE_TIER {tier}", f"FIRST_HITS_TIER {tier}")]
    lines += [f'#include "cuda/{source}"' for source in ("trace.cu", "trace_instanced.cu", "first_hits.cu")]
    return "\n".join(lines) + "\n"


def main():
    root, build, nvcc = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    report = Report()

    def forbid(pattern, text, shown):
        for instruction, count in collections.Counter(pattern.findall(text)).items():
            report.add(shown, f"{count} x {instruction} in the PTX")

    def check(source, defines, folder):
        name = source.name if source.is_relative_to(folder) else source.relative_to(root).as_posix()
        shown = " ".join([name, *defines])
        ptx = folder / "out.ptx"
        fast = FAST_TIER.match(name) or FAST_KERNEL.search(shown)
        exact_flags = ["--fmad=false", "--ftz=false", "--prec-div=true", "--prec-sqrt=true"]
        if source.name != "device_probe.cu":
            exact_flags += ["-Xcicc", "-O0"]
        result = subprocess.run(
            [nvcc, "-ptx", "-std=c++20", "-arch=compute_75", "-rdc=true", "-DTANDEM_NO_LOOSE_FMA", *defines,
             *(["--use_fast_math"] if fast else exact_flags), "-Xcompiler", "-ffp-contract=off", f"-I{root / 'lib'}", f"-I{root}", str(source), "-o", str(ptx)],
            capture_output=True, text=True)
        if result.returncode:
            report.add(shown, f"nvcc fails: {result.stderr.strip()[:2000]}")
            return
        text = ptx.read_text()
        forbid(TRIES_ALL, text, shown)
        if fast:
            if "fma.rn.ftz.f32" not in text or "sqrt.approx.ftz.f32" not in text:
                report.add(shown, "does not contract or approximate, which is what the tier fast is for")
            print(f"{shown}: {len(re.findall(r'[.]approx', text))} approximations")
            return
        forbid(FORBIDDEN, text, shown)
        entries = len(re.findall(r"^\s*(?:\.visible |\.weak )?\.entry", text, re.M))
        print(f"{shown}: {entries} kernels, {len(re.findall(r'fma.rn.f64', text))} written fma.rn.f64")

    units = [unit for source in sorted((root / "cuda").glob("*.cu")) for unit in units_of(source)]
    units.append((root / "tests/lint/device_probe.cu", []))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for tier in ("strict", "precise"):
            together = folder / f"{tier}.cu"
            together.write_text(exact_kernels(tier))
            units.append((together, []))
        for source, defines in units:
            check(source, defines, folder)
    linked = [path for tier in ("strict", "precise") for path in sorted((build / "cuda").glob(f"compiled_*_{tier}.ptx"))]
    for path in linked:
        forbid(FORBIDDEN_IN_BUILD, path.read_text(), path.name)
        forbid(TRIES_ALL, path.read_text(), path.name)
    report.finish(f"{len(units)} compilations, {len(linked)} linked kernels")


main()
