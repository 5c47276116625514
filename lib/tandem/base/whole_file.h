/// Files read and written as a whole.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tandem {

using Bytes = std::vector<std::byte>;

/// What write_file() waits for before it renames the file.
enum class Durability {
    written,  ///< the operating system has the bytes: survives the end of the program
    synced,   ///< the disk has them: survives a power cut
};

/// All bytes of a regular file of at most 16 GiB. Throws InputError with the path and the reason.
[[nodiscard]] Bytes read_file(const std::string& path);

/// Writes a file at `path`, whole or not at all: the bytes go to a hidden temporary file beside it, which is closed and
/// renamed over the target. On failure the temporary file is removed, the target stays as it was, and the error names
/// path and reason: InputError if the path is wrong (no folder, no permission, a folder in its place), EnvironmentError
/// if the machine fails (no space, input/output error). Safe from several threads at once.
void write_file(const std::string& path, std::span<const std::byte> bytes, Durability durability = Durability::synced);
void write_file(const std::string& path, std::string_view text, Durability durability = Durability::synced);

/// Throws InputError if write_file() could not write there now: for programs that check before hours of work.
void check_can_write(const std::string& path);

}  // namespace tandem
