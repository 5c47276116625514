#include "tandem/render/registry.h"

#include <array>

namespace tandem {

std::span<const BackendEntry> backend_registry() { return {}; }

}  // namespace tandem
