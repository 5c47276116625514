/// A first look at an EXR file, not part of the interface: OpenEXR allocates by the sizes that a header claims, so they
/// are checked against the bytes that are there before it sees them.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tandem {

/// Throws InputError if a header is cut off or claims more pixels, channels, blocks or bytes than the file can hold, or
/// if the first part is deep. All else is left to OpenEXR. Layout: "OpenEXR File Layout", openexr.com.
void check_exr_header(std::span<const std::byte> bytes, const std::string& name);

}  // namespace tandem
