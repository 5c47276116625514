/// Cubins of specialised kernels, kept on disk. Processes and threads may share a folder: an entry is written
/// completely and then renamed, the last one wins, and all entries for a key are equally good. Entries that are
/// incomplete, altered or foreign are not used. The cache only saves time: nothing in it throws, and problems are
/// returned as text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tandem::cuda {

class KernelCache {
  public:
    static constexpr std::uint64_t default_limit_bytes = std::uint64_t{256} << 20;

    /// An empty path is a cache that keeps nothing. The folder is created when there is something to put into it.
    explicit KernelCache(std::filesystem::path folder, std::uint64_t limit_bytes = default_limit_bytes)
        : folder_(std::move(folder)), limit_bytes_(limit_bytes) {}

    struct Found {
        std::vector<std::byte> cubin;  ///< empty if there is no entry, or none to be trusted
        std::string problem;           ///< what is wrong with the entry; empty if it is good, or if there is none
    };
    /// `key` is a SHA-256 in hexadecimal of everything that the cubin depends on.
    [[nodiscard]] Found find(const std::string& key) const;

    /// Empty, or why the cubin could not be kept. Then removes the least recently used entries, down to the limit;
    /// other files stay.
    [[nodiscard]] std::string store(const std::string& key, std::span<const std::byte> cubin) const;

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  private:
    [[nodiscard]] std::filesystem::path entry(const std::string& key) const;
    void evict(const std::filesystem::path& keep) const;

    std::filesystem::path folder_;
    std::uint64_t limit_bytes_;
};

/// The user's folder for cubins: kernels/ in TANDEM_CACHE_DIR, else in tandem/ of XDG_CACHE_HOME, else in
/// ~/.cache/tandem/. Empty, for no cache, if TANDEM_CACHE_DIR is set to nothing, or if there is no home.
[[nodiscard]] std::filesystem::path kernel_cache_folder();

}  // namespace tandem::cuda
