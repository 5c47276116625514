#!/usr/bin/env python3
"""Checks on the source: what would break equal bits, and which file may include which library.

usage: sources.py ROOT BUILD
"""

import pathlib
import re
import sys

from lint import BASELINE, CPP, FAST_FLAGS, FAST_KERNEL, FAST_MATH, FAST_TIER, KERNEL_ROOMS, Report, compile_commands, files, search, without_comments

ALL_ROOMS = ("lib", "cpu", "cuda", "apps")

# Square root, fma, rint and fabs are exact; they are wrapped in lib/tandem/math and called nowhere else.
EXACT_LIBM = {"sqrt", "sqrtf", "fma", "fmaf", "rint", "fabs", "fabsf"}
LIBM = re.compile(
    r"(?<![\w.>])(?:std::|::)?("
    r"(?:a?(?:sin|cos|tan)h?|atan2|exp2?|expm1|log(?:2|10|1p|b)?|pow|hypot|cbrt|erfc?|[lt]gamma|sqrt|rsqrt|rcbrt"
    r"|fma|fmin|fmax|fmod|fdim|remainder|floor|ceil|trunc|l?l?round|l?l?rint|nearbyint|fabs|copysign|ldexp|frexp|scalbn?"
    r"|sincos|sinpi|cospi)f?)\s*\(")
# The functions of the C library whose last bit is its author's; the others in LIBM are exact on every host.
UNSETTLED = re.compile(
    r"(?<![\w.>])(?:std::|::)?(a?(?:sin|cos|tan)h?|atan2|exp2?|exp10|expm1|log(?:2|10|1p)?|pow|hypot|cbrt|erfc?|[lt]gamma"
    r"|sincos|(?:sin|cos|tan)pi)[fl]?\s*\((?!\s*\))")
# Their results reach no film and no hash of a scene: the reference that shares nothing with the kernels, reports, the
# errors of pictures, and the paper's method.
REACHES_NO_FILM = ("lib/tandem/oracle/", "lib/tandem/report/", "lib/tandem/accuracy/", BASELINE)
LIBRARY_MIN_MAX = re.compile(r"\bstd::(?:min|max|clamp|lerp|numbers)\b")
INTRINSIC = re.compile(r"\b__(?:f(?:div|mul|add|sub|ma|rcp|sqrt|rsqrt)\w*|d(?:div|mul|add|sub|ma|rcp|sqrt)\w*"
                       r"|sinf|cosf|sincosf|tanf|expf|exp10f|logf|log2f|log10f|powf|saturatef)\s*\(")
EPSILON = re.compile(
    r"\b(?:t_?min|t_?near|ray_?eps(?:ilon)?|eps(?:ilon)?|shadow_?bias|bias)\s*[={(]\s*(?:\w+\s*\(\s*)?(?:\d*\.\d*[1-9]|\d*\.?\d*e-|0x\S*p-)"
    r"|\bt\w*\s*>=?\s*(?:\w+\s*\(\s*)?(?:0\.\d*[1-9]|\d+\.?\d*e-\d|0x\S*p-)")

# header: where it may be included
LIBRARIES = {
    "Embree": (r"embree\d?/", lambda path: path.startswith(("cpu/", BASELINE))),
    "TBB": (r"(?:tbb|oneapi)/", lambda path: path.startswith(("cpu/", BASELINE))),
    "libjpeg": (r"jpeglib\.h", lambda path: path.startswith("lib/tandem/images/")),
    "OpenEXR": (r"(?:OpenEXR|Imath)/", lambda path: path.startswith("lib/tandem/images/")),
}


def check_kernel_header(report, path, code):
    for line, match in search(code, LIBM):
        if match.group(1) in EXACT_LIBM and path.startswith("lib/tandem/math/"):
            continue
        better = "lib/tandem/math/exact_math.h has it" if match.group(1) not in EXACT_LIBM else "lib/tandem/math/real.h wraps it"
        report.add(f"{path}:{line}", f"calls {match.group(1)}() of the C library in a kernel header; {better}")
    for line, match in search(code, LIBRARY_MIN_MAX):
        report.add(f"{path}:{line}", f"{match.group(0)} in a kernel header; use lesser(), greater() or select()")
    for line, match in search(code, INTRINSIC):
        report.add(f"{path}:{line}", f"device intrinsic {match.group(0)[:-1]} in a kernel header")


def check_host_code(report, path, code):
    for line, match in search(code, UNSETTLED):
        report.add(f"{path}:{line}", f"calls {match.group(1)}() of the C library, so that pictures and hashes depend on its "
                                     "release; lib/tandem/math/accurate_functions.h and turns.h have functions of our own")


def main():
    root, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    report = Report()
    count = 0
    for path, text in files(root, ALL_ROOMS, CPP):
        count += 1
        code = without_comments(text)
        if path.startswith(tuple(f"lib/tandem/{room}/" for room in KERNEL_ROOMS)) and path.endswith(".h") and not FAST_TIER.match(path):
            check_kernel_header(report, path, code)
        elif not path.startswith(REACHES_NO_FILM) and not FAST_TIER.match(path):
            check_host_code(report, path, code)
        if not path.startswith(BASELINE):
            for line, match in search(code, EPSILON):
                report.add(f"{path}:{line}", f"absolute epsilon '{match.group(0)}': a hit needs t > 0, whatever the scale")
        for name, (header, allowed) in LIBRARIES.items():
            for line, _ in search(code, rf'#\s*include\s*[<"]{header}'):
                if not allowed(path):
                    report.add(f"{path}:{line}", f"includes {name}, which has one place in the source (docs/architecture.md)")
        for line, _ in search(code, r"\b__global__\b"):
            if not path.startswith(("cuda/", BASELINE)):
                report.add(f"{path}:{line}", "__global__ outside of cuda/")

    for room in (".", "cmake", "scripts", ".ci", *ALL_ROOMS, "tests"):
        for path in sorted((root / room).glob("*") if room == "." else (root / room).rglob("*")):
            relative = path.relative_to(root).as_posix()
            if not path.is_file() or relative.startswith((BASELINE, "tests/lint/", "scripts/lint")):
                continue
            if path.suffix in {".txt", ".cmake", ".json", ".sh", ".in"} or room in {"scripts", ".ci"}:
                for line, match in search(re.sub(r"#[^\n]*", "", path.read_text(errors="replace")), FAST_MATH):
                    if match.group(0) not in FAST_FLAGS.get(relative, ()):
                        report.add(f"{relative}:{line}", f"flag {match.group(0)}")

    commands = 0
    for path, command in compile_commands(build, root):
        if path.startswith(BASELINE):
            continue
        commands += 1
        if FAST_TIER.match(path) or FAST_KERNEL.search(command):
            continue
        for match in FAST_MATH.finditer(command):
            report.add(path, f"is compiled with {match.group(0)}")
        if path.endswith(".cu") and not re.search(r"-fmad=false", command):
            report.add(path, "is compiled without --fmad=false: nvcc would contract a * b + c")
        if not path.endswith(".cu") and "-ffp-contract=off" not in command:
            report.add(path, "is compiled without -ffp-contract=off; link tandem_private (cmake/compile_flags.cmake)")
    report.finish(f"{count} source files, {commands} compile commands")


main()
