/// Scores computed results against correct ones.
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "hard/corpus/answer.h"
#include "tandem/kernel/shapes/hit.h"

namespace tandem::hard {

/// The score of one case on one backend and tier. Tries are rays, calls of a function, or pixels.
class Score {
  public:
    /// Counts a try; if it is `wrong`, keeps a line that reproduces the first such.
    template <std::invocable Describe>
    void decide(bool wrong, Describe describe) {
        ++tried;
        if (!wrong) return;
        ++this->wrong;
        if (first_failure.empty()) first_failure = describe();
    }
    void decide(bool wrong, const std::string& description) {
        decide(wrong, [&] { return description; });
    }

    /// Records an error in ulps, for the worst and the median; keeps the line of the worst.
    template <class Describe>
    void measure(double ulps, Describe describe) {
        ulps_.push_back(ulps);
        if (!(ulps <= worst_) || ulps_.size() == 1) {
            worst_ = ulps;
            worst_description_ = describe();
        }
    }

    [[nodiscard]] double worst_ulps() const { return ulps_.empty() ? 0 : worst_; }
    [[nodiscard]] double median_ulps() const;
    [[nodiscard]] const std::string& worst_description() const { return worst_description_; }

    void add(const Score& other);

    std::size_t tried = 0;
    std::size_t unjudged = 0;  ///< left out: not judged
    std::size_t wrong = 0;
    std::size_t leaks = 0;    ///< of the wrong: rays that left a closed surface
    std::size_t nans = 0;     ///< answers that are NaN
    std::size_t refused = 0;  ///< of the wrong: not answered at all
    double seconds = 0;       ///< of tracing, or rendering; 0 where nothing is timed
    std::string first_failure;

  private:
    std::vector<double> ulps_;
    double worst_ = 0;
    std::string worst_description_;
};

/// The id for a ray that a renderer refused.
inline constexpr std::uint32_t refused_primitive = 0xFFFFFFFEU;

/// Scores answers against the correct ones. `watertight`: a miss where something is hit is a leak.
[[nodiscard]] Score score_hits(std::span<const Ray<float>> rays, std::span<const Answer> answers,
                               std::span<const Hit> hits, bool watertight);

/// Distance of a float from a value that was rounded to double, in ulps.
[[nodiscard]] double ulps_from(float value, double right);

/// A ray as a C++ literal.
[[nodiscard]] std::string to_literal(const Ray<float>& ray);

}  // namespace tandem::hard
