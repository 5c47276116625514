#!/usr/bin/env python3
"""Checks that a source outside tests/ includes what it names of other libraries, itself or through our own headers.

The compilers of the tests do not: the build compiles files together (TANDEM_UNITY), lint.clang parses them after a precompiled
header, and which other headers a header of the standard library includes depends on the release.

usage: includes.py ROOT
"""

import functools
import pathlib
import re
import sys

from lint import Report, files, without_comments

ROOMS = ("lib", "cpu", "apps", "cuda")
FOLDERS = [pathlib.PurePath(name) for name in ("lib", ".", "apps", "apps/bench")]  # of include paths

# Header: the names that it declares. A name that is neither here nor in ANYWHERE is a finding.
NAMES = {
    "algorithm": "adjacent_find all_of any_of binary_search clamp copy copy_if copy_n count count_if equal fill fill_n find "
                 "find_if find_if_not for_each includes lower_bound max max_element min min_element minmax_element mismatch "
                 "none_of nth_element partition replace replace_if reverse rotate sort stable_partition stable_sort "
                 "transform unique upper_bound",
    "array": "array",
    "atomic": "atomic atomic_ref memory_order_relaxed",
    "bit": "bit_cast bit_ceil countl_zero countr_zero endian popcount rotl",
    "cctype": "isalnum isalpha",
    "cfenv": "fegetenv fenv_t fesetenv",
    "charconv": "from_chars to_chars",
    "chrono": "chrono",
    "cmath": "acos asin atan atan2 cbrt ceil cos erf exp exp2 floor fmax fmin fmod hypot ilogb isfinite isinf isnan "
             "isnormal ldexp llround log log10 log1p log2 lround nan nanf nextafter pow rint round signbit sin sqrt tan",
    "concepts": "convertible_to integral invocable same_as",
    "condition_variable": "condition_variable",
    "csetjmp": "jmp_buf longjmp",
    "cstddef": "byte to_integer",
    "cstdint": "int16_t int32_t int64_t int8_t uint16_t uint32_t uint64_t uint8_t uintmax_t uintptr_t",
    "cstdio": "fclose fflush FILE fopen fprintf fputc fputs fread fwrite printf puts rename snprintf",
    "cstdlib": "aligned_alloc exit free getenv malloc strtoull system",
    "cstring": "memcmp memcpy memset strcmp strerror strlen strncpy",
    "ctime": "clock",
    "deque": "deque",
    "exception": "current_exception exception exception_ptr make_exception_ptr rethrow_exception",
    "filesystem": "filesystem",
    "fstream": "ifstream ofstream",
    "functional": "function less",
    "future": "async future future_status launch shared_future",
    "istream": "istream",
    "iterator": "back_inserter istreambuf_iterator next",
    "limits": "numeric_limits",
    "map": "map multimap",
    "memory": "default_delete enable_shared_from_this make_shared make_unique shared_ptr unique_ptr weak_ptr",
    "mutex": "call_once lock_guard mutex once_flag unique_lock",
    "new": "align_val_t bad_alloc",
    "numbers": "numbers",
    "numeric": "accumulate iota",
    "optional": "nullopt optional",
    "queue": "priority_queue",
    "random": "mt19937_64 random_device",
    "regex": "regex sregex_iterator",
    "set": "multiset set",
    "span": "as_bytes span",
    "sstream": "istringstream ostringstream",
    "stdexcept": "logic_error runtime_error",
    "string": "getline stod stoi stoul string to_string",
    "string_view": "string_view",
    "system_error": "errc error_code generic_category system_error",
    "thread": "jthread this_thread thread",
    "tuple": "tie tuple tuple_cat tuple_size_v",
    "type_traits": "conditional_t decay_t integral_constant is_arithmetic_v is_base_of_v is_floating_point_v is_integral_v "
                   "is_same_v is_standard_layout_v is_trivially_copyable_v is_unsigned_v remove_reference_t type_identity_t",
    "unordered_set": "unordered_set",
    "utility": "as_const exchange forward index_sequence make_index_sequence move pair swap",
    "variant": "get_if holds_alternative variant variant_size_v visit",
    "vector": "vector",
}
ANYWHERE = set("abs begin end erase_if get ptrdiff_t size size_t streamsize".split())  # many headers declare them
DECLARED_BY = {name: header for header, names in NAMES.items() for name in names.split()}
# Headers that give their users what another declares: in what they return, or as the base of a class.
BRINGS = {"charconv": "system_error", "filesystem": "system_error", "fstream": "istream", "sstream": "istream",
          "stdexcept": "exception"}
# Namespaces of other libraries, and the folder of their headers.
LIBRARIES = {"CLI": "CLI/", "Imf": "OpenEXR/", "fmt": "fmt/", "nlohmann": "nlohmann/", "tbb": "tbb/"}
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:<([^>]+)>|"([^"]+)")', re.M)


@functools.cache
def included(root, path):
    """(headers of other libraries, our own files) that the #include lines of a file name."""
    lines = INCLUDE.findall((root / path).read_text())
    places = [folder / own for _, own in lines if own for folder in (path.parent, *FOLDERS)]
    return {foreign for foreign, _ in lines if foreign}, [place for place in places if (root / place).is_file()]


def reached(root, path):
    """The headers of other libraries that a file includes, itself or through our own files."""
    found, seen, ours = set(), set(), [pathlib.PurePath(path)]
    while ours:
        here = ours.pop()
        if here not in seen:
            seen.add(here)
            foreign, own = included(root, here)
            found |= foreign
            ours += own
    return found | {BRINGS[header] for header in found if header in BRINGS}


def declared_ahead(code, namespace):
    """The classes of a library that the code declares without defining them, which needs no header."""
    return set(re.findall(r"\b(?:class|struct) (\w+);", " ".join(re.findall(rf"\bnamespace {namespace} {{([^{{}}]*)}}", code))))


def lacking(code, headers):
    """A sentence for each name in the code that these headers do not declare."""
    for name in sorted(set(re.findall(r"\bstd::(\w+)", code)) - ANYWHERE):
        if name not in DECLARED_BY:
            yield f"names std::{name}, which NAMES in tests/lint/includes.py does not know; add it there"
        elif DECLARED_BY[name] not in headers:
            yield f"names std::{name}, but neither it nor what it includes of ours includes <{DECLARED_BY[name]}>"
    for namespace, folder in LIBRARIES.items():
        named = set(re.findall(rf"(?<![\w:]){namespace}::(\w+)", code)) - declared_ahead(code, namespace)
        if named and not any(header.startswith(folder) for header in headers):
            yield f"names {namespace}::, but neither it nor what it includes of ours includes a header of <{folder}>"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    report = Report()
    checked = [(path, text) for path, text in files(root, ROOMS, {".h", ".cpp", ".cu"})]
    for path, text in checked:
        for finding in lacking(without_comments(text), reached(root, path)):
            report.add(path, finding)
    report.finish(f"{len(checked)} files")


main()
