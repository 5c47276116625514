#!/usr/bin/env python3
"""Prints the polynomial coefficients of lib/tandem/math/exact_math.h, turns.h and fast_math.h (angles) and the error of each
fit (needs mpmath).

A Remez exchange on the weighted error; coefficients are then rounded to double one by one, lowest first, and the
others fitted again, so that the rounding of one is taken up by the rest.
"""
import mpmath as mp

mp.mp.prec = 320


def remez(f, weight, lower, upper, fixed, terms, rounds=8):
    """Coefficients c of sum c_i x^i, i < terms, least in max |weight (f - p)| on [lower, upper]; `fixed` are given."""
    free = terms - len(fixed)
    if free == 0:
        return list(fixed), error_of(f, weight, lower, upper, fixed)
    nodes = [(lower + upper) / 2 + (upper - lower) / 2 * mp.cos(mp.pi * (2 * i + 1) / (2 * free + 2))
             for i in range(free, -1, -1)]
    for _ in range(rounds):
        matrix = mp.matrix(free + 1, free + 1)
        right = mp.matrix(free + 1, 1)
        for i, x in enumerate(nodes):
            w = weight(x)
            known = sum(c * x**k for k, c in enumerate(fixed))
            for j in range(free):
                matrix[i, j] = w * x**(len(fixed) + j)
            matrix[i, free] = (-1)**i
            right[i] = w * (f(x) - known)
        solution = mp.lu_solve(matrix, right)
        coefficients = list(fixed) + [solution[j] for j in range(free)]
        nodes = extrema(lambda x: weight(x) * (f(x) - mp.polyval(coefficients[::-1], x)), lower, upper, nodes)
    return coefficients, error_of(f, weight, lower, upper, coefficients)


def extrema(error, lower, upper, nodes):
    """One extremum of alternating sign near each node."""
    samples = 24 * len(nodes)
    grid = [(lower + upper) / 2 - (upper - lower) / 2 * mp.cos(mp.pi * i / samples) for i in range(samples + 1)]
    values = [error(x) for x in grid]
    best = []
    for x, v in zip(grid, values):
        if best and mp.sign(best[-1][1]) == mp.sign(v):
            if abs(v) > abs(best[-1][1]):
                best[-1] = (x, v)
        elif v != 0:
            best.append((x, v))
    while len(best) > len(nodes):
        best.pop(0 if abs(best[0][1]) < abs(best[-1][1]) else -1)
    return [x for x, _ in best] if len(best) == len(nodes) else nodes


def error_of(f, weight, lower, upper, coefficients):
    grid = [lower + (upper - lower) * mp.mpf(i) / 300 for i in range(301)]
    return max(abs(weight(x) * (f(x) - mp.polyval(coefficients[::-1], x))) for x in grid)


def fit(name, f, weight, lower, upper, terms, first=()):
    rounded = list(first)
    for i in range(len(first), terms):
        coefficients, _ = remez(f, weight, lower, upper, rounded, terms)
        rounded.append(mp.mpf(float(coefficients[i])))
    error = error_of(f, weight, lower, upper, rounded)
    print(f"{name}: relative error below 2^{float(mp.log(error, 2)):.1f}")
    print("    " + ", ".join(float(c).hex() for c in rounded))


def taylor(term, x, count=32):
    return mp.fsum(term(n, x) for n in range(count))


if __name__ == "__main__":
    half_ln2 = mp.log(2) / 2 * (1 + mp.mpf(2)**-20)
    quarter_pi2 = (mp.pi / 4 * (1 + mp.mpf(2)**-20))**2
    s2 = ((mp.sqrt(2) - 1) / (mp.sqrt(2) + 1) * (1 + mp.mpf(2)**-20))**2
    tiny = mp.mpf(2)**-60

    # log(1 + f) = 2 s + s z P(z), s = f / (2 + f), z = s^2; relative to 2 s
    fit("log", lambda z: taylor(lambda n, x: 2 * x**n / (2 * n + 3), z), lambda z: z / 2, tiny, s2, 7)
    # e^r = 1 + r + z E(z) + r z O(z), z = r^2, E and O the tails of cosh and sinh; E begins with 1/2
    fit("exp, even", lambda z: taylor(lambda n, x: x**n / mp.factorial(2 * n + 2), z), lambda z: z, tiny, half_ln2**2,
        6, [mp.mpf(0.5)])
    fit("exp, odd", lambda z: taylor(lambda n, x: x**n / mp.factorial(2 * n + 3), z),
        lambda z: z * mp.sqrt(z), tiny, half_ln2**2, 5)
    # sin r = r + r z S(z), z = r^2; relative to r
    fit("sin", lambda z: taylor(lambda n, x: (-1)**(n + 1) * x**n / mp.factorial(2 * n + 3), z), lambda z: z, tiny,
        quarter_pi2, 7)
    # cos r = 1 - z/2 + z^2 C(z)
    fit("cos", lambda z: taylor(lambda n, x: (-1)**n * x**n / mp.factorial(2 * n + 4), z), lambda z: z * z, tiny,
        quarter_pi2, 7)
    # atan t = t + t z A(z), z = t^2; relative to t
    eighth2 = (mp.tan(mp.pi / 8) * (1 + mp.mpf(2)**-20))**2
    for terms in (4, 11):
        fit("atan", lambda z: (mp.atan(mp.sqrt(z)) - mp.sqrt(z)) / (z * mp.sqrt(z)), lambda z: z, tiny, eighth2, terms)
    # the same for float
    fit("sin, float", lambda z: taylor(lambda n, x: (-1)**(n + 1) * x**n / mp.factorial(2 * n + 3), z), lambda z: z,
        tiny, quarter_pi2, 3)
    fit("cos, float", lambda z: taylor(lambda n, x: (-1)**n * x**n / mp.factorial(2 * n + 4), z), lambda z: z * z,
        tiny, quarter_pi2, 3)
    for name, value in (("ln 2", mp.log(2)), ("pi/2", mp.pi / 2), ("2/pi", 2 / mp.pi)):
        parts, rest = [], value
        for _ in range(3):
            parts.append(mp.mpf(float(rest)))
            rest -= parts[-1]
        print(name, [float(p).hex() for p in parts])
    high = mp.floor(mp.log(2) * 2**42) / 2**42  # 42 bits: products with an exponent are exact
    print("ln 2 split", float(high).hex(), float(mp.log(2) - high).hex(),
          float(mp.log(2) - high - mp.mpf(float(mp.log(2) - high))).hex())
    print("2/pi in chunks of 29 bits:")
    rest = 2 / mp.pi
    for i in range(1, 9):
        chunk = mp.floor(rest * mp.mpf(2)**(29 * i))
        rest -= chunk / mp.mpf(2)**(29 * i)
        print("   ", float(chunk / mp.mpf(2)**(29 * i)).hex())
