#!/usr/bin/env python3
"""The checks themselves, on lines that they must and must not find."""

import pathlib
import tempfile
import unittest

import lint
import rooms


class Comments(unittest.TestCase):
    def test_are_blanked_and_lines_kept(self):
        text = 'a; // sinf(x)\n/* expf(\n) */ b; f("powf(");\n#include <a/b.h>\n#include "c/x.h"\n'
        code = lint.without_comments(text)
        self.assertNotIn("sinf", code)
        self.assertNotIn("expf", code)
        self.assertNotIn("powf", code)
        self.assertIn("<a/b.h>", code)
        self.assertIn('"c/x.h"', code)
        self.assertEqual(text.count("\n"), code.count("\n"))


class FirstIncludes(unittest.TestCase):
    def first_includes(self, **files):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name, "lib")
            folder.mkdir()
            for stem, text in files.items():
                (folder / f"{stem}.h").write_text(text)
            return [path.stem for path in lint.first_includes(folder / "source.h", folder.parent)]

    def test_follow_the_first_directive_of_each_file(self):
        self.assertEqual(self.first_includes(source='/// Text.\n#pragma once\n\n#include "a.h"\n#include "c.h"\n',
                                             a='#include "b.h"\n', b="#include <cmath>\n", c=""), ["a", "b"])

    def test_end_at_a_condition_a_macro_or_a_foreign_header(self):
        for first in ("#if 0\n", "#define A\n", "#include <cmath>\n", '#include "missing.h"\n'):
            self.assertEqual(self.first_includes(source=first + '#include "a.h"\n', a=""), [], first)


class FastMath(unittest.TestCase):
    def test_flags(self):
        for flag in ("-ffast-math", "-Ofast", "--use_fast_math", "-use_fast_math", "-ffp-contract=fast", "--fmad=true"):
            self.assertTrue(lint.FAST_MATH.search(flag), flag)
        for flag in ("-ffp-contract=off", "--fmad=false", "-O3", "--Ofast-compile=max", "-fno-math-errno", "--prec-div=true"):
            self.assertFalse(lint.FAST_MATH.search(flag), flag)


class Patterns(unittest.TestCase):
    def setUp(self):
        import importlib.util
        import pathlib
        import sys
        self.modules = {}
        for name in ("sources", "objects", "ptx", "includes"):
            path = pathlib.Path(__file__).with_name(name + ".py")
            source = path.read_text().rsplit("\nmain()", 1)[0]
            module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, None))
            exec(compile(source, str(path), "exec"), module.__dict__)  # without running it
            self.modules[name] = module

    def test_names_without_their_headers(self):
        def found(code, *headers):
            return [finding.split()[1].rstrip(",") for finding in self.modules["includes"].lacking(code, set(headers))]
        code = "std::vector<std::size_t> a; fmt::format(); my::fmt::c d;"
        self.assertEqual(found(code, "vector", "fmt/core.h"), [])
        self.assertEqual(found(code, "string"), ["std::vector", "fmt::"])
        self.assertEqual(found("std::unheard_of b;", "vector"), ["std::unheard_of"])
        ahead = "namespace fmt { class context; struct a; } namespace my { class format; } "
        self.assertEqual(found(ahead + "fmt::context& b; fmt::a* c;"), [])
        self.assertEqual(found(ahead + "fmt::context& b; fmt::format();"), ["fmt::"])

    def test_headers_are_reached_through_our_own(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name, "lib")
            folder.mkdir()
            (folder / "a.h").write_text('#include "b.h"\n')
            (folder / "b.h").write_text('#include "a.h"\n#include <charconv>\n')
            self.assertEqual(self.modules["includes"].reached(pathlib.Path(name), "lib/a.h"), {"charconv", "system_error"})

    def test_libm_calls(self):
        pattern = self.modules["sources"].LIBM
        for code in ("sinf(x)", "std::pow(a, b)", "::exp (x)", "= fminf(a, b)", "fmax(a, b)", "std::floor(x)"):
            self.assertTrue(pattern.search(code), code)
        for code in ("exact_sin(x)", "cosine(x)", "a.exp(x)", "log_wide<Real>(x)", "square_root(x)", "power(x, y)"):
            self.assertFalse(pattern.search(code), code)

    def test_unsettled_functions(self):
        pattern = self.modules["sources"].UNSETTLED
        for code in ("std::sin(x)", "cosf(x)", "::atan2 (y, x)", "= std::cbrt(v)", "powl(a, b)", "std::log10(x)"):
            self.assertTrue(pattern.search(code), code)
        for code in ("accurate_sin(x)", "std::sqrt(x)", "std::ldexp(x, 2)", "result.log(x)", "catalog(x)", "log()", "std::lround(x)"):
            self.assertFalse(pattern.search(code), code)

    def test_epsilons(self):
        pattern = self.modules["sources"].EPSILON
        for code in ("float t_min = 0.001F;", "epsilon = 1e-4f", "tmin(1e-3F)", "if (t > 1e-4)", "t_near >= Real(1e-3F)"):
            self.assertTrue(pattern.search(code), code)
        for code in ("t_min = 0;", "t > zero", "t_near > 0.0", "height > 1e-3"):
            self.assertFalse(pattern.search(code), code)

    def test_instructions(self):
        self.assertTrue(self.modules["objects"].FUSED.search("  1a:\tvfmadd213pd %ymm0,%ymm1,%ymm2"))
        self.assertTrue(self.modules["objects"].FUSED.search("  1a:\tvfnmsub132sd %xmm0,%xmm1,%xmm2"))
        self.assertFalse(self.modules["objects"].FUSED.search("  1a:\tvmulpd %ymm0,%ymm1,%ymm2"))
        self.assertTrue(self.modules["objects"].NEWER.search("cpu/CMakeFiles/tandem_cpu_strict_v3_alone.dir/kernels/query.cpp.o"))
        self.assertFalse(self.modules["objects"].NEWER.search("cpu/CMakeFiles/tandem_cpu_strict_v2_alone.dir/kernels/query.cpp.o"))
        forbidden = self.modules["ptx"].FORBIDDEN
        for line in ("\tsqrt.approx.f32 %f1, %f2;", "\tmul.ftz.f32 %f1, %f2, %f3;", "\tdiv.full.f32 %f1, %f2, %f3;",
                     "\t@%p1 fma.rn.ftz.f32 %f1, %f2, %f3, %f4;"):
            self.assertTrue(forbidden.search(line), line)
        for line in ("\tfma.rn.f64 %fd1, %fd2, %fd3, %fd4;", "\tdiv.rn.f32 %f1, %f2, %f3;", "\tsqrt.rn.f64 %fd1, %fd2;"):
            self.assertFalse(forbidden.search(line), line)

    def test_baseline_may_fuse_only_in_functions_that_ask_the_processor(self):
        count = self.modules["objects"].fused_operations
        code = "\n0000 <_Z5plaind>:\n  0:\tvfmadd213sd %xmm0\n\n0010 <_Z17for_each_with_fmaIZ>:\n 10:\tvfmadd213sd %xmm0\n"
        self.assertEqual(count(code, is_newer=False), 1)
        self.assertEqual(count(code, is_newer=True), 2)


class Rooms(unittest.TestCase):
    """Small trees with a table of their own."""

    table = {"lib/tandem/base": "none", "lib/tandem/kernel/shapes": "base", "lib/tandem/kernel": "base, kernel/shapes",
             "tests": "all above"}
    sources = {
        "lib/tandem/base/error.h": "",
        "lib/tandem/kernel/shapes/box.h": '#include "tandem/base/error.h"\n#include <vector>\n',
        "lib/tandem/kernel/path.h": '#include "tandem/kernel/shapes/box.h"\n  # include <tandem/base/error.h>\n#include "near.h"\n',
        "lib/tandem/kernel/near.h": "",
        "tests/kernel/path_test.cpp": '#include "tandem/kernel/path.h"\n',
    }

    def findings(self, table=(), sources=(), without=()):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder).resolve()
            rows = "".join(f"| `{room}` | words | {names} |\n" for room, names in {**self.table, **dict(table)}.items() if room not in without)
            page = "# Page\n\n## Rooms\n\n| room | what is in it | may include |\n|---|---|---|\n" + rows + "\n## More\n\n| `x/y` | a | b |\n"
            for path, text in {"docs/architecture.md": page, **self.sources, **dict(sources)}.items():
                if text is not None:
                    (root / path).parent.mkdir(parents=True, exist_ok=True)
                    (root / path).write_text(text)
            report = lint.Report()
            rooms.check(root, report)
            return report.findings

    def expect(self, words, **changes):
        found = self.findings(**changes)
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])

    def test_agree(self):
        self.assertEqual(self.findings(), [])

    def test_an_include_is_not_in_the_table(self):
        self.expect("path.h:2: lib/tandem/kernel includes lib/tandem/base", table={"lib/tandem/kernel": "kernel/shapes"})

    def test_no_include_needs_what_the_table_allows(self):
        self.expect("lib/tandem/kernel/shapes may include base, and no include does", sources={"lib/tandem/kernel/shapes/box.h": "// base/error.h\n"})

    def test_a_folder_has_no_row(self):
        self.expect("lib/tandem/film: is no room", sources={"lib/tandem/film/film.h": ""})
        self.expect("lib/tandem/kernel/lights: is no room", sources={"lib/tandem/kernel/lights/spot.h": ""})
        self.expect("cpu: is no room", sources={"cpu/backend.cpp": ""})

    def test_a_row_has_no_folder(self):
        self.expect("the room cuda has no sources", table={"cuda": "none"})

    def test_a_row_names_no_room(self):
        self.expect("may include 'bass', which is no room", table={"lib/tandem/kernel": "base, bass, kernel/shapes"})

    def test_a_circle(self):
        up = {"lib/tandem/base/error.h": '#include "tandem/kernel/near.h"\n'}
        self.expect("which is not above it", table={"lib/tandem/base": "kernel"}, sources=up)
        self.expect("error.h:1: lib/tandem/base includes lib/tandem/kernel, which the table", sources=up)

    def test_a_room_that_may_include_all_above(self):
        self.expect("main.cpp:1: tests includes apps, which is not above it", table={"apps": "none"},
                    sources={"tests/main.cpp": '#include "apps/window.h"\n', "apps/window.h": ""})

    def test_no_table(self):
        self.assertIn("has no table of rooms", self.findings(without=tuple(self.table))[0])


unittest.main()
