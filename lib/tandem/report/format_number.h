/// Numbers for human readers.
#pragma once

#include <string>

#include "tandem/report/statistics.h"

namespace tandem {

/// Three significant digits with a suitable unit: "4.72 ms", "35.3 s".
[[nodiscard]] std::string format_seconds(double seconds);

/// Three significant digits with k, M or G: "1.45 G".
[[nodiscard]] std::string format_count(double count);

/// Three significant digits, without a unit, with separated thousands: "0.0512", "157", "35,329".
[[nodiscard]] std::string format_number(double value);

/// "12.5 %"; "0" only for exactly zero.
[[nodiscard]] std::string format_share(double share);

/// "13.2 ms ± 0.1 ms" (median and median absolute deviation).
[[nodiscard]] std::string format_summary(const Summary& seconds);

/// "12.9 (12.5 to 13.3)", with the 95 % interval in brackets if there is one.
[[nodiscard]] std::string format_ratio(const Ratio& ratio);

}  // namespace tandem
