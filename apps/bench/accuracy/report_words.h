/// The accuracy report in words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/sweep.h"

namespace tandem::bench {

/// "0.0123 (0.0121 to 0.0125)"; "below 0.003" for an error that cannot be told from zero.
[[nodiscard]] std::string in_words(const ErrorEstimate& error);

/// "5.1 ms (5.0 ms to 5.3 ms)", with the interval of the median if there is one.
[[nodiscard]] std::string in_words(const Summary& seconds);

/// What a digit costs on each backend, what failed, and what to choose: a sentence each.
[[nodiscard]] std::vector<std::string> answers(const SceneSweep& sweep, const std::vector<SweepBackend>& backends);

/// Each setting that has not failed against the baseline, and what is biased: a sentence each.
[[nodiscard]] std::vector<std::string> comparisons(const SceneSweep& sweep, const std::vector<SweepBackend>& backends);

/// The price of a tenth of the error: of the baseline on a backend, from the points whose error is resolved.
[[nodiscard]] PowerLaw price_law(const SceneSweep& sweep, const std::string& backend);

/// What the words of the report mean, for readers who have not seen one before.
[[nodiscard]] std::string meaning_of_words();

/// The exponent of the RMSE against the samples of a setting, from the points whose error is resolved; nothing for
/// fewer than two.
[[nodiscard]] std::optional<Exponent> convergence(const SceneSweep& sweep, const std::string& backend,
                                                  const Setting& setting);

/// "-0.98 (-1.01 to -0.95)".
[[nodiscard]] std::string in_words(const Exponent& exponent);

/// What the report did not vary, for all scenes.
[[nodiscard]] std::string not_varied(const SweepOptions& options);

}  // namespace tandem::bench
