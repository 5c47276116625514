#include "tandem/accuracy/student_t.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace tandem {

double student_t_within(double value, int degrees) {
    assert(value >= 0 && degrees >= 1);
    const double angle = std::atan(value / std::sqrt(static_cast<double>(degrees)));
    const double sine = std::sin(angle), cosine = std::cos(angle);
    const bool odd = degrees % 2 == 1;
    // Odd: cos + 2/3 cos^3 + ..., up to cos^(degrees - 2). Even: 1 + 1/2 cos^2 + ..., likewise
    double term = odd ? cosine : 1;
    double series = odd && degrees == 1 ? 0 : term;
    for (int power = odd ? 3 : 2; power <= degrees - 2; power += 2) {
        term *= cosine * cosine * (power - 1) / power;
        series += term;
    }
    return odd ? 2 / std::numbers::pi * (angle + sine * series) : sine * series;
}

double student_t_bound(double confidence, int degrees) {
    assert(confidence >= 0 && confidence < 1);
    double low = 0, high = 1;
    while (student_t_within(high, degrees) < confidence) high *= 2;
    for (int step = 0; step < 80; ++step) {
        const double middle = (low + high) / 2;
        (student_t_within(middle, degrees) < confidence ? low : high) = middle;
    }
    return (low + high) / 2;
}

}  // namespace tandem
