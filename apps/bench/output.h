/// Where a report goes.
#pragma once

#include <string>

#include "tandem/report/report.h"

namespace tandem::bench {

/// "-" is standard output; empty means not wanted.
struct OutputOptions {
    std::string json;
    std::string csv;
    std::string html;
};

/// Writes the files that were asked for, each whole or not at all. Throws InputError if two want standard output.
/// True if one of them took it.
bool write_report(const Report& report, const OutputOptions& options);

/// The text for a terminal, to standard output.
void print_report(const Report& report);

/// A line on standard error: what is being measured now.
void log_progress(const std::string& text);

}  // namespace tandem::bench
