#include "tandem/report/plot_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tandem/report/format_number.h"

namespace tandem {

namespace {

/// The step 1, 2 or 5 times a power of ten that divides `range` into about seven parts.
double round_step(double range) {
    const double rough = range / 7;
    const double decade = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (rough <= factor * decade * 1.0001) return factor * decade;
    }
    return 10 * decade;
}

std::string tick_label(double value) {
    const double magnitude = std::abs(value);
    if (magnitude >= 1e6) return format_count(value);
    if (magnitude > 0 && magnitude < 1e-3) return fmt::format("{:.0e}", value);
    return format_number(value);
}

}  // namespace

AxisScale::AxisScale(std::span<const double> values, bool logarithmic, double pixels)
    : logarithmic_(logarithmic), pixels_(pixels) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    bool has_zero = false;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        if (logarithmic && value <= 0) {
            has_zero = true;
            continue;
        }
        least = std::min(least, value);
        most = std::max(most, value);
    }
    if (least > most) least = most = logarithmic ? 1 : 0;  // no finite values
    if (logarithmic) {
        cover_logarithmic(least, most, has_zero);
    } else {
        cover_linear(least, most);
    }
}

void AxisScale::cover_linear(double least, double most) {
    least = std::min(least, 0.0);
    most = std::max(most, 0.0);
    if (most <= least) most = 1;
    const double step = round_step(most - least);
    const auto first = static_cast<int>(std::floor(least / step + 1e-9));
    const auto last = static_cast<int>(std::ceil(most / step - 1e-9));
    for (int i = first; i <= last; ++i) ticks_.push_back({i * step, tick_label(i * step)});
    low_ = first * step;
    high_ = last * step;
}

void AxisScale::cover_logarithmic(double least, double most, bool has_zero) {
    const double span = std::log10(most / least);
    const int first = static_cast<int>(std::floor(std::log10(least) + 1e-9));
    const int last = static_cast<int>(std::ceil(std::log10(most) - 1e-9));
    const auto decade = [](int exponent) { return std::pow(10.0, exponent); };
    low_ = first;
    high_ = std::max(last, first + 1);
    if (span < 2) {
        static constexpr std::array factors = {1.0, 2.0, 5.0};
        std::vector<double> candidates;
        for (int exponent = first; exponent <= last; ++exponent) {
            for (const double factor : factors) candidates.push_back(factor * decade(exponent));
        }
        const auto above = std::upper_bound(candidates.begin(), candidates.end(), least * 1.0001);
        const auto begin = above == candidates.begin() ? above : above - 1;
        auto end = std::lower_bound(candidates.begin(), candidates.end(), most * 0.9999);
        if (end == begin) ++end;
        if (end == candidates.end()) --end;
        for (auto tick = begin; tick <= end; ++tick) ticks_.push_back({*tick, tick_label(*tick)});
        low_ = std::log10(ticks_.front().value);
        high_ = std::log10(ticks_.back().value);
    } else {
        const int stride = 1 + (last - first) / 10;
        for (int exponent = first; exponent <= last; exponent += stride) {
            ticks_.push_back({decade(exponent), tick_label(decade(exponent))});
        }
    }
    if (high_ <= low_) high_ = low_ + 1;
    if (has_zero) {
        low_ -= std::max(0.25, 0.12 * (high_ - low_));
        ticks_.insert(ticks_.begin(), {0, "0"});
    }
}

double AxisScale::position(double value) const {
    if (logarithmic_) {
        if (value <= 0) return 0;
        value = std::log10(value);
    }
    return std::clamp((value - low_) / (high_ - low_), 0.0, 1.0) * pixels_;
}

}  // namespace tandem
