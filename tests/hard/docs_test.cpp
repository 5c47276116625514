// Compares the tables of docs/accuracy.md and docs/hard-corpus.md with the code. After a change of the cases or error
// bounds, write them again: TANDEM_UPDATE_DOCS=1 hard_tests --gtest_filter='HardDocs.*'.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "hard/corpus/error_bounds.h"
#include "hard/corpus/hard_case.h"
#include "tandem/base/whole_file.h"

namespace tandem::hard {
namespace {

std::string share(double value) { return value == 0 ? "0" : fmt::format("{:g} %", 100 * value); }
std::string ulps(double value) { return std::isinf(value) ? "any" : fmt::format("{:g}", value); }

std::string cell_of(const ErrorBound* bound) {
    if (bound == nullptr) return "";
    std::string text = fmt::format("{} / {}", share(bound->wrong), ulps(bound->ulps));
    if (bound->leaks > 0) text += fmt::format(" / {} leaks", share(bound->leaks));
    return text;
}

std::string error_bounds_table() {
    std::string text = "| case | strict | precise | fast |\n|---|---|---|---|\n";
    for (const HardCase& hard_case : corpus()) {
        text += fmt::format("| {} {} | {} | {} | {} |\n", hard_case.id, hard_case.title,
                            cell_of(find_error_bound(hard_case.id, Tier::strict)),
                            cell_of(find_error_bound(hard_case.id, Tier::precise)),
                            cell_of(find_error_bound(hard_case.id, Tier::fast)));
    }
    return text;
}

std::string cases_table() {
    std::string text = "| case | what is tested | why naive code fails | oracle |\n|---|---|---|---|\n";
    for (const HardCase& hard_case : corpus()) {
        const char* kind = hard_case.has_rays() ? "" : hard_case.on_host() ? " (functions)" : " (images)";
        text += fmt::format("| {} | {}{} | {} | {} |\n", hard_case.id, hard_case.title, kind, hard_case.why,
                            hard_case.oracle);
    }
    return text;
}

/// The part of a page between the two lines.
void expect_part(const std::string& page, const std::string& name, const std::string& wanted) {
    const std::string path = std::string(TANDEM_DOCS) + "/" + page;
    const Bytes bytes = read_file(path);
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string first = fmt::format("<!-- {}: written by hard_tests -->\n\n", name), last = "\n<!-- end -->";
    const std::size_t begin = text.find(first);
    ASSERT_NE(begin, std::string::npos) << path;
    const std::size_t start = begin + first.size();
    const std::size_t end = text.find(last, start);
    ASSERT_NE(end, std::string::npos) << path;
    if (std::getenv("TANDEM_UPDATE_DOCS") != nullptr) {
        text.replace(start, end - start, wanted);
        write_file(path, std::string_view(text), Durability::written);
    } else {
        EXPECT_EQ(text.substr(start, end - start), wanted) << path;
    }
}

TEST(HardDocs, ErrorBoundsMatchTheCode) { expect_part("accuracy.md", "error bounds", error_bounds_table()); }
TEST(HardDocs, CasesMatchTheCode) { expect_part("hard-corpus.md", "cases", cases_table()); }

}  // namespace
}  // namespace tandem::hard
