#!/usr/bin/env python3
"""Checks that clang++ takes every source outside tests/, the CPU's kernels once per tier.

The build compiles them with g++ alone and, with TANDEM_UNITY, together; lint.headers instantiates few templates. clang++ only
parses the files and generates no code: each of the library alone, so that its headers are known to need no others before
them; those of programs as the build compiles them, in a third of the time. Most of them begin with a precompiled header of
other libraries: without it, their headers take more than half of the time. lint.includes checks that each file includes what
it needs of them.

usage: clang.py ROOT BUILD
"""

import collections
import concurrent.futures
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

from lint import Report, WARNINGS, compile_commands, is_of_a_program, is_parsed_alone
from precompiled import precompile

KEPT = re.compile(r"-[DI]\S|-std=|-march=|-ffp-contract=")
# The arguments in which the precompiled header and a source that begins with it must agree.
COMMON = re.compile(r"-std=|-march=|-ffp-contract=|-DFMT_|-DNDEBUG")
TIER = re.compile(r"-DTANDEM_KERNEL_TIER=(\w+)")


def arguments_of(command):
    """What of g++'s command line clang++ needs: definitions, folders, language, instruction set."""
    words = shlex.split(command)
    return [part for word, following in zip(words, words[1:] + [""])
            for part in ([word, following] if word == "-isystem" else [word] if KEPT.match(word) else [])]


def main():
    root, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    inside = f"{build.relative_to(root).as_posix()}/" if build.is_relative_to(root) else ""
    report = Report()
    sources = {}
    for path, command in compile_commands(build, root, together=is_of_a_program):
        if is_of_a_program(path.removeprefix(inside)) or is_parsed_alone(path, root, build):
            tier = TIER.search(command)
            sources[path, tier.group(1) if tier else ""] = arguments_of(command)  # of the last instruction set

    if not sources:
        sys.exit(f"{build}/compile_commands.json names no source under {root}: give the folder that was configured with it")

    def common(source):
        return tuple(argument for argument in sources[source] if COMMON.match(argument))

    usual, _ = collections.Counter(map(common, sources)).most_common(1)[0]

    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        header = precompile(usual, folder)

        def parse(source):
            begin = ["-include-pch", header] if common(source) == usual else []
            return source, subprocess.run(
                ["clang++", "-fsyntax-only", *WARNINGS, *begin, *sources[source], root / source[0]],
                capture_output=True, text=True)

        for (path, tier), result in pool.map(parse, sources):
            if result.returncode:
                first = next((line for line in result.stderr.splitlines() if "error" in line), result.stderr[:300])
                report.add(f"{path} {tier}".rstrip(), f"clang++ does not take it: {first}")
    report.finish(f"{len(sources)} sources with clang++")


main()
