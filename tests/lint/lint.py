"""What the lint checks share: the repository's files, C++ without its comments, compile commands, and the report."""

import json
import pathlib
import re
import sys

KERNEL_ROOMS = ("math", "kernel")
WARNINGS = ["-Wall", "-Wextra", "-Wconversion", "-Wundef", "-Werror"]
CPP = {".h", ".cpp", ".cu", ".def", ".inl"}
# The paper's method re-created to be measured, not used: its arithmetic is its own.
BASELINE = "apps/bench/baseline/"
# The tier fast: its files, and no others, may use what the exact tiers must not (docs/tiers.md). The CPU's kernels of all
# tiers are the same files, and so are those of the GPU; a definition tells them apart.
FAST_TIER = re.compile(r"^lib/tandem/math/fast_\w+\.h$")
FAST_KERNEL = re.compile(r"-DTANDEM_(?:KERNEL|TRACE|FIRST_HITS)_TIER=fast\b")
FAST_FLAGS = {"cpu/CMakeLists.txt": {"-ffp-contract=fast"}, "cuda/CMakeLists.txt": {"--use_fast_math"}}
FAST_MATH = re.compile(
    r"-ffast-math|-Ofast\b(?!-compile)|-funsafe-math-optimizations|-ffinite-math-only|-fassociative-math|-freciprocal-math"
    r"|-fno-signed-zeros|-ffp-contract=(?:fast|on)|-mdaz-ftz|-?-use_fast_math|-?-ftz=true|-?-fmad=true"
    r"|-?-prec-div=false|-?-prec-sqrt=false")


class Report:
    """Collects findings, one line each, and ends the program."""

    def __init__(self):
        self.findings = []

    def add(self, where, message):
        self.findings.append(f"{where}: {message}")

    def finish(self, checked):
        for finding in self.findings:
            print(finding)
        print(f"{checked}; {len(self.findings)} finding(s)")
        sys.exit(1 if self.findings else 0)


def files(root, rooms, suffixes):
    """Files under the rooms, as (path relative to the root, text)."""
    for room in rooms:
        for path in sorted((root / room).rglob("*")):
            if path.suffix in suffixes and path.is_file():
                yield path.relative_to(root).as_posix(), path.read_text()


def without_comments(text):
    """The same text with comments and the contents of strings blanked, so that lines keep their numbers. The names in
    #include lines stay."""
    def blank(match):
        found = match.group(0)
        if found.startswith('"'):
            line_start = text.rfind("\n", 0, match.start()) + 1
            if text[line_start:match.start()].lstrip().startswith("#"):
                return found
            return '""' + " " * (len(found) - 2)
        return re.sub(r"[^\n]", " ", found)

    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', blank, text, flags=re.S)


def search(text, pattern):
    """(line number, match) of every match."""
    for match in re.finditer(pattern, text):
        yield text.count("\n", 0, match.start()) + 1, match


def compile_commands(build, root, together=lambda source: False):
    """(path relative to the root, command line) of our own files. Sources that CMake includes in one of its own
    (TANDEM_UNITY) come one by one, except those that are asked for `together`."""
    commands = build / "compile_commands.json"
    if not commands.exists():
        sys.exit(f"{commands} is missing: configure with CMAKE_EXPORT_COMPILE_COMMANDS=ON and a Ninja or Makefile generator")
    for entry in json.loads(commands.read_text()):
        path = pathlib.Path(entry["directory"], entry["file"]).resolve()
        if path.is_relative_to(root):
            sources = [source for source in compiled_together(path) or [path] if source.is_relative_to(root)]
            if sources and all(together(source.relative_to(root).as_posix()) for source in sources):
                sources = [path]
            for source in sources:
                yield source.relative_to(root).as_posix(), entry["command"]


def compiled_together(path):
    """The sources that CMake includes in one of its own, if `path` is one (TANDEM_UNITY)."""
    if "/Unity/" not in path.as_posix():
        return []
    return [pathlib.Path(name).resolve() for name in re.findall(r'^#include "(.*)"$', path.read_text(), re.M)]


def is_parsed_alone(path, root, build):
    """Does lint.clang parse this source alone? All of them outside tests/, except those of programs."""
    return path.endswith(".cpp") and not path.startswith(("tests/", "apps/")) and not (root / path).is_relative_to(build)


def is_of_a_program(path):
    """Is it a C++ source of a program, or several that CMake compiles together?"""
    return path.startswith("apps/") and path.endswith((".cpp", ".cxx"))


def first_includes(source, root):
    """The headers of lib/ that a source reads before anything else: the one that its first directive includes, the one
    that this header's first directive includes, and so on. They compile alone if the source does, but for headers of other
    libraries, which lint.clang precompiles and lint.includes checks."""
    while True:
        directives = re.findall(r"^\s*#\s*(?!pragma)(\w+)\s*(.*)$", source.read_text(), re.M)
        if not directives or directives[0][0] != "include" or not directives[0][1].startswith('"'):
            return
        source = root / "lib" / directives[0][1].split('"')[1]
        if not source.exists():
            return
        yield source
