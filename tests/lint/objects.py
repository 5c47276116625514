#!/usr/bin/env python3
"""Checks on the object files of the library: fused multiply-adds, and symbols that the linker may merge.

An object for the baseline instruction set holds no fused multiply-add, except in functions whose names hold "_with_fma":
their callers ask the processor first. An object for a newer set (its name holds _v3 or _v4) may define a weak symbol only
under a name that carries the set, and no function with such a name is weak: the linker keeps one of several equal weak
symbols, and it must not be one that older machines cannot run.

usage: objects.py BUILD [OBJDUMP [NM]]
"""

import pathlib
import re
import subprocess
import sys

from lint import Report

NEWER = re.compile(r"_v[34]\b|_v[34][._]")
FUNCTION = re.compile(r"^[0-9a-f]+ <(.+)>:$", re.MULTILINE)
FUSED = re.compile(r"\tv?fn?m(?:add|sub)\w*")
MAY_FUSE = re.compile("_with_fma")
ISA_TAG = re.compile(r"Sse4|Avx2|Avx512")


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def fused_operations(code, is_newer):
    """How many of them a disassembly has; for the baseline, outside of functions that may have them."""
    _, *functions = FUNCTION.split(code)
    return sum(len(FUSED.findall(body)) for name, body in zip(functions[::2], functions[1::2])
               if is_newer or not MAY_FUSE.search(name))


def main():
    build = pathlib.Path(sys.argv[1])
    objdump = sys.argv[2] if len(sys.argv) > 2 else "objdump"
    nm = sys.argv[3] if len(sys.argv) > 3 else "nm"
    objects = sorted(path for room in ("lib", "cpu", "cuda") for path in (build / room).rglob("*.o"))
    report = Report()
    if not objects:
        report.add(build, "holds no object files of the library; build it first")
    fused = 0
    for path in objects:
        name = path.relative_to(build).as_posix()
        is_newer = NEWER.search(name) is not None
        count = fused_operations(run(objdump, "-d", "--no-show-raw-insn", str(path)), is_newer)
        if is_newer:
            fused += count
            print(f"{name}: {count} fused multiply-adds")
        elif count:
            report.add(name, f"{count} fused multiply-adds in an object for the baseline instruction set")
        for line in run(nm, "--defined-only", str(path)).splitlines():
            kind, symbol = line.split()[-2:]
            if kind not in "WVuwv" or symbol.startswith("DW.ref."):
                continue
            if MAY_FUSE.search(symbol) or (is_newer and not ISA_TAG.search(symbol)):
                report.add(name, f"weak symbol {symbol} without the name of an instruction set: mark it TANDEM_HD or "
                                 "give it internal linkage")
    report.finish(f"{len(objects)} objects")


main()
