#!/usr/bin/env python3
"""Prints the polynomials of lib/tandem/kernel/sampler/pixel_filter.h and how far their densities are from those of the
filters (needs mpmath).

The distance from the middle is x(t) = R (1 - t^2) + t^2 (1 - t) p(t - 1/2), where t^4 is the share of the filter's weight
farther away. Least squares of the relative error of dx/dt, which is that of the density, weighted by the probability.
Coefficients are rounded to six digits.
"""
import mpmath as mp

mp.mp.dps = 50
RADIUS = mp.mpf(3) / 2
TERMS = 7
WINDOW = [mp.mpf(a) for a in ("0.35875", "0.48829", "0.14128", "0.01168")]
END = mp.exp(-2 * RADIUS**2)

# each filter's function of a coordinate, and its integral from 0
FILTERS = {
    "gaussian": (lambda x: mp.exp(-2 * x * x) - END, lambda x: mp.sqrt(mp.pi / 8) * mp.erf(x * mp.sqrt(2)) - END * x),
    "blackman_harris": (lambda x: sum(a * mp.cos(k * mp.pi * x / RADIUS) for k, a in enumerate(WINDOW)),
                        lambda x: WINDOW[0] * x + sum(a * RADIUS / (k * mp.pi) * mp.sin(k * mp.pi * x / RADIUS)
                                                      for k, a in enumerate(WINDOW) if k > 0)),
}


def distance(integral, share):
    """Beyond which the filter has this share, by bisection."""
    low, high = mp.mpf(0), RADIUS
    for _ in range(100):
        middle = (low + high) / 2
        if integral(middle) < integral(RADIUS) * (1 - share):
            low = middle
        else:
            high = middle
    return (low + high) / 2


def nodes(function, integral, count):
    """t, dx/dt and the weight of the probability, at Chebyshev's nodes."""
    for i in range(count):
        angle = mp.pi * (2 * i + 1) / (2 * count)
        t = (1 - mp.cos(angle)) / 2
        probability = 4 * t**3
        yield t, -integral(RADIUS) * probability / function(distance(integral, t**4)), mp.sin(angle) * probability


def derivative(k, t):
    """Of t^2 (1 - t) (t - 1/2)^k."""
    z = t - mp.mpf(1) / 2
    return (2 * t - 3 * t**2) * z**k + (k * (t**2 - t**3) * z**(k - 1) if k > 0 else 0)


def fit(function, integral):
    matrix, right = mp.matrix(TERMS, TERMS), mp.matrix(TERMS, 1)
    for t, slope, weight in nodes(function, integral, 400):
        row = [derivative(k, t) for k in range(TERMS)]
        for i in range(TERMS):
            right[i] += weight / slope**2 * row[i] * (slope + 2 * RADIUS * t)
            for j in range(TERMS):
                matrix[i, j] += weight / slope**2 * row[i] * row[j]
    return [float(mp.nstr(c, 6)) for c in mp.lu_solve(matrix, right)]


if __name__ == "__main__":
    for name, (function, integral) in FILTERS.items():
        coefficients = fit(function, integral)
        variation = total = mp.mpf(0)
        for t, slope, weight in nodes(function, integral, 500):
            ours = -2 * RADIUS * t + sum(c * derivative(k, t) for k, c in enumerate(coefficients))
            variation += weight * abs(ours / slope - 1) / 2
            total += weight
        print(f"{name}: total variation {float(variation / total):.2e}")
        print("    " + ", ".join(f"{c:g}" for c in coefficients))
