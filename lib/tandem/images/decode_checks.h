/// Checks that all decoders share; internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace tandem {

/// Throws InputError: "'name' is not a readable FORMAT image: reason".
[[noreturn]] void fail_decoding(const std::string& name, const char* format, const std::string& reason);

/// Throws unless both edges are from 1 to 65536, and the film from 1 to 2^30 pixels, the limits of a render job.
void check_size(const std::string& name, const char* format, std::uint64_t width, std::uint64_t height);

/// The same for textures, whose edges are at most most_texture_edge.
void check_texture_size(const std::string& name, const char* format, std::uint64_t width, std::uint64_t height);

/// Throws if `available` bytes of a file cannot hold `needed` bytes of pixels: detects forged or truncated files before
/// memory is allocated.
void check_data(const std::string& name, const char* format, std::size_t available, std::size_t needed);

/// Throws if decoding takes more work (TexelSize::work) than decoding_limit() allows.
void check_work(const std::string& name, const char* format, std::size_t available, std::size_t work);

/// The largest compression ratio of a deflate stream.
inline constexpr std::size_t most_deflate_ratio = 1032;

}  // namespace tandem
