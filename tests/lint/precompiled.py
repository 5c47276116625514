"""The headers of other libraries, which take most of the time to parse a file of ours. clang++ alone."""

import pathlib
import subprocess
import sys

from lint import WARNINGS

PRECOMPILED = ("algorithm", "array", "atomic", "charconv", "chrono", "cmath", "cstring", "deque", "filesystem", "fstream",
               "functional", "future", "limits", "map", "memory", "mutex", "numbers", "numeric", "optional", "set", "span",
               "sstream", "string", "system_error", "thread", "variant", "vector",
               "CLI/CLI.hpp", "fmt/format.h", "fmt/ranges.h", "nlohmann/json.hpp", "tbb/parallel_for.h")


def precompile(arguments, folder):
    """The precompiled header, in the folder, of the libraries that are installed."""
    header = pathlib.Path(folder, "libraries.pch")
    # Without -fpch-instantiate-templates each source would instantiate the templates of these headers again.
    result = subprocess.run(
        ["clang++", "-x", "c++-header", "-fpch-instantiate-templates", *WARNINGS, *arguments, "-", "-o", header],
        input="".join(f"#if __has_include(<{name}>)\n#include <{name}>\n#endif\n" for name in PRECOMPILED),
        capture_output=True, text=True)
    if result.returncode:
        sys.exit(f"clang++ does not compile the headers of other libraries:\n{result.stderr[:2000]}")
    return header
