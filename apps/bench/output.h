/// Where a report goes.
#pragma once

#include <string>

#include "tandem/report/report.h"

namespace tandem::bench {

/// "-" is standard output; empty means none.
struct OutputOptions {
    std::string json;
    std::string csv;
    std::string html;
};

/// Writes the files that were asked for, each whole or not at all. True if one of them went to standard output. Throws
/// InputError if two would.
bool write_report(const Report& report, const OutputOptions& options);

/// The text for a terminal, to standard output.
void print_report(const Report& report);

/// Prints what is being measured now, as a line on standard error.
void log_progress(const std::string& text);

}  // namespace tandem::bench
