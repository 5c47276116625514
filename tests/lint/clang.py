#!/usr/bin/env python3
"""Checks that clang++ takes every source outside tests/, the CPU's kernels once per tier.

The build compiles them with g++ alone and, with TANDEM_UNITY, together; lint.headers instantiates few templates. clang++ only
parses the files, each alone, and generates no code.

usage: clang.py ROOT BUILD
"""

import concurrent.futures
import os
import pathlib
import re
import shlex
import subprocess
import sys

from lint import Report, WARNINGS, compile_commands, is_parsed_alone

KEPT = re.compile(r"-[DI]\S|-std=|-march=|-ffp-contract=")
TIER = re.compile(r"-DTANDEM_KERNEL_TIER=(\w+)")


def arguments_of(command):
    """What of g++'s command line clang++ needs: definitions, folders, language, instruction set."""
    words = shlex.split(command)
    return [part for word, following in zip(words, words[1:] + [""])
            for part in ([word, following] if word == "-isystem" else [word] if KEPT.match(word) else [])]


def main():
    root, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    report = Report()
    sources = {}
    for path, command in compile_commands(build, root):
        if is_parsed_alone(path, root, build):
            tier = TIER.search(command)
            sources[path, tier.group(1) if tier else ""] = arguments_of(command)  # of the last instruction set

    def parse(source):
        return source, subprocess.run(["clang++", "-fsyntax-only", *WARNINGS, *sources[source], root / source[0]],
                                      capture_output=True, text=True)

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for (path, tier), result in pool.map(parse, sources):
            if result.returncode:
                first = next((line for line in result.stderr.splitlines() if "error" in line), result.stderr[:300])
                report.add(f"{path} {tier}".rstrip(), f"clang++ does not take it: {first}")
    report.finish(f"{len(sources)} sources with clang++")


main()
