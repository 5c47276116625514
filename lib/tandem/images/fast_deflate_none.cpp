// For a build without ISA-L.
#include <stdexcept>

#include "tandem/images/fast_deflate.h"

namespace tandem {

struct FastDeflate::State {};

bool FastDeflate::is_available() { return false; }

FastDeflate::FastDeflate() { throw std::logic_error("this build of Tandem has no ISA-L: FastDeflate::is_available()"); }

FastDeflate::~FastDeflate() = default;

void FastDeflate::begin() {}

std::span<const std::uint8_t> FastDeflate::compress(std::span<const std::uint8_t>, Then) { return {}; }

std::uint32_t FastDeflate::adler32(std::uint32_t before, std::span<const std::uint8_t>) { return before; }

}  // namespace tandem
