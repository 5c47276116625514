/// A backend that is made while its scene is: starting a GPU takes a third of a second.
#pragma once

#include <memory>
#include <string>

#include "tandem/render/backend.h"

namespace tandem {

class BackendAhead : public Backend {
  public:
    /// Throws what the first call would throw, if that is known already: without a GPU it is, after a moment.
    virtual void check_so_far() const = 0;
};

/// The same as make_backend(), made by another thread; the first call of a function waits for it. What make_backend()
/// would throw is thrown by that call.
[[nodiscard]] std::unique_ptr<BackendAhead> make_backend_ahead(const std::string& name,
                                                               const BackendOptions& options = {});

}  // namespace tandem
