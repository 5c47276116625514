#include "tandem/images/portable_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "tandem/images/decode_checks.h"

namespace tandem {

void PortableMapHeader::skip_blank() {
    for (; at_ < text_.size(); ++at_) {
        if (text_[at_] == '#') {
            const std::size_t end = std::min(text_.find('\n', at_), text_.size());
            std::string_view line = text_.substr(at_ + 1, end - at_ - 1);
            if (line.starts_with(' ')) line.remove_prefix(1);
            if (line.ends_with('\r')) line.remove_suffix(1);
            if (auto entry = parse_metadata_line(line)) comments_.push_back(std::move(*entry));
            at_ = end;
            if (at_ == text_.size()) return;
        } else if (!is_blank(text_[at_])) {
            return;
        }
    }
}

std::string_view PortableMapHeader::word() {
    skip_blank();
    const std::size_t start = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    if (at_ == start) fail_decoding(name_, format_, "its header is cut off");
    return text_.substr(start, at_ - start);
}

std::string_view PortableMapHeader::pixels() {
    if (at_ == text_.size()) fail_decoding(name_, format_, "its header is cut off");
    return text_.substr(at_ + 1);
}

void PortableMapHeader::fail_number(const char* what, std::string_view token) const {
    const std::string_view shown = token.substr(0, 32);
    fail_decoding(name_, format_, fmt::format("its {} is '{}', which is not a valid number", what, shown));
}

}  // namespace tandem
