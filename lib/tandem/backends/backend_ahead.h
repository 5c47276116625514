/// A backend that is made while its scene is: starting a GPU takes a third of a second.
#pragma once

#include <memory>
#include <string>

#include "tandem/render/backend.h"

namespace tandem {

/// The same as make_backend(), made by another thread; the first call of a function waits for it. What make_backend()
/// would throw is thrown by that call.
[[nodiscard]] std::unique_ptr<Backend> make_backend_ahead(const std::string& name, const BackendOptions& options = {});

}  // namespace tandem
