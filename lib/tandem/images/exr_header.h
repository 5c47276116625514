/// Checks the headers of an EXR file; internal. OpenEXR allocates memory by the sizes that a header claims, so these
/// are first compared with the size of the file.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tandem {

/// Throws InputError if a header is cut off or claims more pixels, channels, blocks or bytes than the file can hold, or
/// if the first part is deep. OpenEXR checks the rest. Layout: "OpenEXR File Layout", openexr.com.
void check_exr_header(std::span<const std::byte> bytes, const std::string& name);

}  // namespace tandem
