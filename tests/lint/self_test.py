#!/usr/bin/env python3
"""The checks themselves, on lines that they must and must not find."""

import unittest

import lint


class Comments(unittest.TestCase):
    def test_are_blanked_and_lines_kept(self):
        text = 'a; // sinf(x)\n/* expf(\n) */ b; f("powf(");\n#include <glm/vec3.hpp>\n#include "glm/x.h"\n'
        code = lint.without_comments(text)
        self.assertNotIn("sinf", code)
        self.assertNotIn("expf", code)
        self.assertNotIn("powf", code)
        self.assertIn("<glm/vec3.hpp>", code)
        self.assertIn('"glm/x.h"', code)
        self.assertEqual(text.count("\n"), code.count("\n"))


class FastMath(unittest.TestCase):
    def test_flags(self):
        for flag in ("-ffast-math", "-Ofast", "--use_fast_math", "-use_fast_math", "-ffp-contract=fast", "--fmad=true"):
            self.assertTrue(lint.FAST_MATH.search(flag), flag)
        for flag in ("-ffp-contract=off", "--fmad=false", "-O3", "-fno-math-errno", "--prec-div=true"):
            self.assertFalse(lint.FAST_MATH.search(flag), flag)


class Patterns(unittest.TestCase):
    def setUp(self):
        import importlib.util
        import pathlib
        import sys
        self.modules = {}
        for name in ("sources", "objects", "ptx"):
            path = pathlib.Path(__file__).with_name(name + ".py")
            source = path.read_text().rsplit("\nmain()", 1)[0]
            module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, None))
            exec(compile(source, str(path), "exec"), module.__dict__)  # without running it
            self.modules[name] = module

    def test_libm_calls(self):
        pattern = self.modules["sources"].LIBM
        for code in ("sinf(x)", "std::pow(a, b)", "::exp (x)", "= fminf(a, b)", "fmax(a, b)", "std::floor(x)"):
            self.assertTrue(pattern.search(code), code)
        for code in ("exact_sin(x)", "cosine(x)", "a.exp(x)", "log_wide<Real>(x)", "square_root(x)", "power(x, y)"):
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
        self.assertTrue(self.modules["objects"].NEWER.search("cpu/CMakeFiles/tandem_cpu_strict_v3.dir/kernels/query.cpp.o"))
        self.assertFalse(self.modules["objects"].NEWER.search("cpu/CMakeFiles/tandem_cpu_strict_v2.dir/kernels/query.cpp.o"))
        forbidden = self.modules["ptx"].FORBIDDEN
        for line in ("\tsqrt.approx.f32 %f1, %f2;", "\tmul.ftz.f32 %f1, %f2, %f3;", "\tdiv.full.f32 %f1, %f2, %f3;",
                     "\t@%p1 fma.rn.ftz.f32 %f1, %f2, %f3, %f4;"):
            self.assertTrue(forbidden.search(line), line)
        for line in ("\tfma.rn.f64 %fd1, %fd2, %fd3, %fd4;", "\tdiv.rn.f32 %f1, %f2, %f3;", "\tsqrt.rn.f64 %fd1, %fd2;"):
            self.assertFalse(forbidden.search(line), line)


unittest.main()
