#include "cuda/kernel_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string_view>
#include <system_error>

#include "tandem/base/sha256.h"
#include "tandem/base/whole_file.h"

namespace tandem::cuda {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view suffix = ".cubin";
constexpr char format_mark[9] = "TDMCUB01";

/// The header before the cubin in a file. Little endian, like all machines that Tandem runs on.
struct Header {
    char mark[8];
    std::uint64_t cubin_bytes;
    char key[64];
    char checksum[64];  ///< SHA-256 of the fields above and of the cubin
};
static_assert(sizeof(Header) == 144);

std::string checksum(const Header& header, std::span<const std::byte> cubin) {
    Sha256 hash;
    hash.update(&header, offsetof(Header, checksum));
    hash.update(cubin.data(), cubin.size());
    return hash.hex();
}

Header make_header(const std::string& key, std::span<const std::byte> cubin) {
    Header header{};
    std::memcpy(header.mark, format_mark, sizeof header.mark);
    header.cubin_bytes = cubin.size();
    std::memcpy(header.key, key.data(), sizeof header.key);
    std::memcpy(header.checksum, checksum(header, cubin).data(), sizeof header.checksum);
    return header;
}

bool is_key(std::string_view text) {
    return text.size() == sizeof Header::key && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Whether a file is an entry, or the temporary file of an interrupted store (lib/tandem/base/whole_file.cpp):
/// .KEY.cubin.PROCESS-COUNT.tmp
enum class FileKind { entry, unfinished, other };
FileKind kind_of(std::string_view name) {
    const bool hidden = name.starts_with('.');
    if (hidden) name.remove_prefix(1);
    if (!is_key(name.substr(0, sizeof Header::key))) return FileKind::other;
    name.remove_prefix(sizeof Header::key);
    if (!hidden) return name == suffix ? FileKind::entry : FileKind::other;
    return name.starts_with(suffix) && name.ends_with(".tmp") ? FileKind::unfinished : FileKind::other;
}

struct Kept {
    fs::path path;
    std::uint64_t bytes;
    fs::file_time_type used;
};

}  // namespace

fs::path KernelCache::entry(const std::string& key) const { return folder_ / (key + std::string(suffix)); }

KernelCache::Found KernelCache::find(const std::string& key) const {
    if (folder_.empty() || !is_key(key)) return {};
    const fs::path path = entry(key);
    std::error_code error;
    if (!fs::exists(path, error)) return {};
    const auto unusable = [&](std::string_view why) {
        return Found{{}, fmt::format("the cache entry '{}' is not used: {}", path.string(), why)};
    };
    const std::uint64_t size = fs::file_size(path, error);
    if (error) return unusable(error.message());
    if (size > limit_bytes_) return unusable("it is larger than the limit of the cache");
    Bytes bytes;
    try {
        bytes = read_file(path.string());
    } catch (const std::exception& failure) {
        return unusable(failure.what());
    }
    Header header;
    if (bytes.size() < sizeof header) return unusable("it is too short");
    std::memcpy(&header, bytes.data(), sizeof header);
    bytes.erase(bytes.begin(), bytes.begin() + sizeof header);
    const Header expected = make_header(key, bytes);
    if (std::memcmp(&header, &expected, sizeof header) != 0)
        return unusable("it is incomplete, altered, or of another key");
    fs::last_write_time(path, fs::file_time_type::clock::now(), error);  // ignores failure: the folder may be read-only
    return {std::move(bytes), {}};
}

std::string KernelCache::store(const std::string& key, std::span<const std::byte> cubin) const {
    if (folder_.empty()) return {};
    if (!is_key(key)) return fmt::format("'{}' is not a key of the kernel cache", key);
    if (sizeof(Header) + cubin.size() > limit_bytes_) return "a kernel is larger than the limit of the cache";
    const Header header = make_header(key, cubin);
    const auto* first = reinterpret_cast<const std::byte*>(&header);
    Bytes bytes(first, first + sizeof header);
    bytes.insert(bytes.end(), cubin.begin(), cubin.end());
    try {
        fs::create_directories(folder_);
        // no need to survive a power cut: the checksum detects incomplete files
        write_file(entry(key).string(), bytes, Durability::written);
    } catch (const std::exception& failure) {
        return fmt::format("cannot write to the kernel cache: {}", failure.what());
    }
    evict(entry(key));
    return {};
}

void KernelCache::evict(const fs::path& keep) const {
    const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
    std::vector<Kept> entries;
    std::uint64_t total = 0;
    std::error_code error;
    for (auto file = fs::directory_iterator(folder_, error); !error && file != fs::directory_iterator();
         file.increment(error)) {
        const FileKind kind = kind_of(file->path().filename().string());
        std::error_code gone;  // another process may be evicting as well
        const auto used = file->last_write_time(gone);
        const std::uint64_t bytes = gone || kind == FileKind::other ? 0 : file->file_size(gone);
        if (gone) continue;
        if (kind == FileKind::unfinished && used < long_ago) fs::remove(file->path(), gone);
        if (kind != FileKind::entry) continue;
        total += bytes;
        if (file->path() != keep) entries.push_back({file->path(), bytes, used});
    }
    std::sort(entries.begin(), entries.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
    for (const Kept& oldest : entries) {
        if (total <= limit_bytes_) break;
        std::error_code gone;
        fs::remove(oldest.path, gone);
        total -= oldest.bytes;
    }
}

fs::path kernel_cache_folder() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return fs::path(value != nullptr ? value : "");
    };
    if (std::getenv("TANDEM_CACHE_DIR") != nullptr) {
        const fs::path named = variable("TANDEM_CACHE_DIR");
        return named.empty() ? named : named / "kernels";
    }
    // the XDG base directory specification says to ignore relative paths
    if (const fs::path cache = variable("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "tandem/kernels";
    if (const fs::path home = variable("HOME"); home.is_absolute()) return home / ".cache/tandem/kernels";
    return {};
}

}  // namespace tandem::cuda
