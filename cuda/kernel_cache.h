/// A disk cache of specialised kernels. Processes and threads may share a folder: an entry is written completely and
/// then renamed, the last one wins, and all entries of a key are equivalent. Incomplete, altered and foreign entries
/// are not used. The cache only saves time: it never throws, and returns problems as text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tandem::cuda {

class KernelCache {
  public:
    static constexpr std::uint64_t default_limit_bytes = std::uint64_t{256} << 20;

    /// With an empty path nothing is cached. The folder is created when the first entry is stored.
    explicit KernelCache(std::filesystem::path folder, std::uint64_t limit_bytes = default_limit_bytes)
        : folder_(std::move(folder)), limit_bytes_(limit_bytes) {}

    struct Found {
        std::vector<std::byte> cubin;  ///< empty if there is no valid entry
        std::string problem;           ///< what is wrong with the entry; empty if it is valid, or if there is none
    };
    /// `key`: SHA-256, in hexadecimal, of everything that the cubin depends on.
    [[nodiscard]] Found find(const std::string& key) const;

    /// Stores a cubin, then removes the least recently used entries, down to the limit; other files stay. Returns why
    /// the cubin could not be stored; empty on success.
    [[nodiscard]] std::string store(const std::string& key, std::span<const std::byte> cubin) const;

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  private:
    [[nodiscard]] std::filesystem::path entry(const std::string& key) const;
    void evict(const std::filesystem::path& keep) const;

    std::filesystem::path folder_;
    std::uint64_t limit_bytes_;
};

/// The user's folder for cubins: kernels/ in TANDEM_CACHE_DIR, else in tandem/ of XDG_CACHE_HOME, else in
/// ~/.cache/tandem/. Empty, for no cache, if TANDEM_CACHE_DIR is set but empty, or if there is no home.
[[nodiscard]] std::filesystem::path kernel_cache_folder();

}  // namespace tandem::cuda
