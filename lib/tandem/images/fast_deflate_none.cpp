// For a build without ISA-L.
#include <stdexcept>

#include "tandem/images/fast_deflate.h"

namespace tandem {

struct FastDeflate::State {};

bool FastDeflate::is_available() { return false; }

FastDeflate::FastDeflate() { throw std::logic_error("this build of Tandem has no ISA-L: FastDeflate::is_available()"); }

FastDeflate::~FastDeflate() = default;

std::span<const std::uint8_t> FastDeflate::compress(std::span<const std::uint8_t>, bool) { return {}; }

}  // namespace tandem
