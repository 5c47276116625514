#!/usr/bin/env python3
"""Compiles every header under lib/ alone, with clang++ or, without it, g++.

clang++ comes first because the build compiles the same headers with g++ already. With it, headers that a source reads before
anything else are left out, since lint.clang parses that source; the others follow a precompiled header of other libraries.
lint.includes finds what headers lack of those.

usage: headers.py ROOT BUILD
"""

import concurrent.futures
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

from lint import Report, WARNINGS, compile_commands, first_includes, is_parsed_alone
from precompiled import precompile


def include_flags(root, build):
    """The -I, -isystem and -D options of all sources under lib/, once each."""
    flags = []
    for path, command in compile_commands(build, root):
        if not path.startswith("lib/"):
            continue
        words = shlex.split(command)
        for word, following in zip(words, words[1:] + [""]):
            flag = [word, following] if word == "-isystem" else [word] if re.match(r"-[ID]\S", word) else None
            if flag and flag not in flags:
                flags.append(flag)
    return [word for flag in flags for word in flag]


def main():
    root, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    report = Report()
    compiler = "clang++" if shutil.which("clang++") else "g++"
    flags = include_flags(root, build)
    headers = set((root / "lib/tandem").rglob("*.h"))
    if compiler == "clang++":
        for path, _ in compile_commands(build, root):
            if path.startswith("lib/") and is_parsed_alone(path, root, build):
                headers -= set(first_includes(root / path, root))

    arguments = ["-std=c++20", "-march=x86-64-v2", "-ffp-contract=off", *flags]
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        begin = ["-include-pch", precompile(arguments, folder)] if compiler == "clang++" else []

        def compile_alone(header):
            result = subprocess.run(
                [compiler, *begin, *arguments, *WARNINGS, "-fsyntax-only", "-x", "c++", "-"],
                input=f'#include "{header.as_posix()}"\n', capture_output=True, text=True)
            return header, result

        for header, result in pool.map(compile_alone, sorted(path.relative_to(root / "lib") for path in headers)):
            if result.returncode:
                first = next((line for line in result.stderr.splitlines() if "error" in line), result.stderr[:300])
                report.add(f"lib/{header}", f"does not compile alone with {compiler}: {first}")
    report.finish(f"{len(headers)} headers with {compiler}, besides those that a source includes first")


main()
