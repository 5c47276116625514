/// The memory that this machine has left.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace tandem {

/// Bytes that this process can still use: what the system has available, and what is left of the limit of its control
/// group, if it has one. Empty if neither is known.
[[nodiscard]] std::optional<std::size_t> available_memory();

/// Throws EnvironmentError if `needed` bytes are more than `available`: "`what` needs at least 30.5 GiB of `where`, but
/// 12.1 GiB are free; make it smaller, or use a machine with more".
void require_memory(std::size_t needed, std::size_t available, const std::string& what, const std::string& where);

/// The same for available_memory(); nothing happens if that is not known.
void require_memory(std::size_t needed, const std::string& what);

}  // namespace tandem
