/// Deflate by ISA-L, several times as fast as zlib and about as small as its level 1. A build without ISA-L has no such
/// compressor; callers then use zlib.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace tandem {

/// Compresses a stream in zlib's format (RFC 1950), piece by piece, in constant memory.
class FastDeflate {
  public:
    /// Whether this build has ISA-L; the other functions need it.
    [[nodiscard]] static bool is_available();

    FastDeflate();
    ~FastDeflate();
    FastDeflate(const FastDeflate&) = delete;
    FastDeflate& operator=(const FastDeflate&) = delete;

    /// Takes the next bytes, less than 4 GiB, and returns those that are ready, which may be none; they are valid until
    /// the next call. `is_last`: ends the stream. Throws std::runtime_error with ISA-L's number of the error.
    [[nodiscard]] std::span<const std::uint8_t> compress(std::span<const std::uint8_t> bytes, bool is_last);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tandem
