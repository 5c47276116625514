/// Git LFS pointers: small files that stand in for large ones in a clone until these are fetched.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace tandem {

/// Whether the text is a pointer file. Source: the specification of Git LFS, docs/spec.md, "The Pointer".
[[nodiscard]] inline bool is_lfs_pointer(std::span<const std::byte> file) {
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    return text.starts_with("version https://git-lfs.github.com/spec/");
}

/// Such a file is shorter than this.
inline constexpr std::size_t lfs_pointer_bytes = 1024;

inline constexpr const char* lfs_advice =
    "is a Git LFS pointer, not the file itself; run 'git lfs pull' in its repository";

}  // namespace tandem
