#include "render/frame_pattern.h"

#include <fmt/format.h>

#include <iterator>
#include <regex>

#include "tandem/base/error.h"

namespace tandem {

FramePattern::FramePattern(const std::string& path) : before_(path) {
    static const std::regex place("%(0[1-9])?d|#+");
    const std::size_t name = path.rfind('/') + 1;  // npos + 1 is 0
    const auto start = path.begin() + static_cast<std::ptrdiff_t>(name);
    const std::sregex_iterator first(start, path.end(), place), end;
    if (first == end) return;
    if (std::next(first) != end) {
        throw InputError(fmt::format("'{}' has more than one placeholder for the frame number; keep one", path));
    }
    const std::string found = first->str();
    has_frame_ = true;
    digits_ = found[0] == '#' ? static_cast<int>(found.size()) : found == "%d" ? 1 : found[2] - '0';
    before_ = path.substr(0, name) + first->prefix().str();
    after_ = first->suffix().str();
}

std::string FramePattern::path(std::uint32_t frame) const {
    return has_frame_ ? fmt::format("{}{:0{}}{}", before_, frame, digits_, after_) : before_;
}

}  // namespace tandem
