/// The version of Tandem.
#pragma once

namespace tandem {

/// "major.minor.patch", from the project's CMakeLists.txt.
[[nodiscard]] const char* version();

}  // namespace tandem
