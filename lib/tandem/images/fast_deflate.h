/// Deflate by ISA-L, several times as fast as zlib and about as small as its level 1. A build without ISA-L has no such
/// compressor; callers then use zlib.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace tandem {

/// Compresses pieces of a stream of deflate (RFC 1951), each in constant memory.
class FastDeflate {
  public:
    /// Whether this build has ISA-L; the other functions need it.
    [[nodiscard]] static bool is_available();

    FastDeflate();
    ~FastDeflate();
    FastDeflate(const FastDeflate&) = delete;
    FastDeflate& operator=(const FastDeflate&) = delete;

    /// Begins a piece, which is independent of the bytes before it.
    void begin();

    /// What follows the bytes: more of this piece; another piece, which starts at a whole byte; or nothing.
    enum class Then { more, piece, end };

    /// Takes the next bytes, less than 4 GiB, and returns those that are ready, which may be none; they are valid until
    /// the next call. Throws std::runtime_error with ISA-L's number of the error.
    [[nodiscard]] std::span<const std::uint8_t> compress(std::span<const std::uint8_t> bytes, Then then);

    /// The checksum Adler-32 (RFC 1950) of bytes that follow those with the checksum `before`, which is 1 for none.
    [[nodiscard]] static std::uint32_t adler32(std::uint32_t before, std::span<const std::uint8_t> bytes);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tandem
