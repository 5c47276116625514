#include "output.h"

#include <fmt/format.h>

#include <cstdio>

#include "tandem/base/error.h"
#include "tandem/base/whole_file.h"
#include "tandem/report/csv_writer.h"
#include "tandem/report/html_writer.h"
#include "tandem/report/json_writer.h"
#include "tandem/report/text_writer.h"

namespace tandem::bench {

bool write_report(const Report& report, const OutputOptions& options) {
    bool standard_output_taken = false;
    const auto write = [&](const std::string& path, const char* option, auto to_text_of) {
        if (path.empty()) return;
        const std::string text = to_text_of();
        if (path != "-") {
            write_file(path, text, Durability::written);
            return;
        }
        if (standard_output_taken)
            throw InputError(fmt::format("{} -: standard output is already in use by another option", option));
        standard_output_taken = true;
        std::fwrite(text.data(), 1, text.size(), stdout);
    };
    write(options.json, "--json", [&] { return to_json(report); });
    write(options.csv, "--csv", [&] { return to_csv(report.rows); });
    write(options.html, "--html", [&] { return to_html(report); });
    return standard_output_taken;
}

void print_report(const Report& report) { fmt::print("{}", to_text(report)); }

void log_progress(const std::string& text) { fmt::print(stderr, "tandem-bench: {}\n", text); }

}  // namespace tandem::bench
