/// A backend that is made while its scene is being made: starting a GPU takes a third of a second.
#pragma once

#include <memory>
#include <string>

#include "tandem/render/backend.h"

namespace tandem {

class BackendAhead : public Backend {
  public:
    /// Throws the exception that the first call would throw, if it is known already. Without a GPU it is known after a
    /// moment.
    virtual void check_so_far() const = 0;
};

/// The same as make_backend(), made by another thread; the first call of a function waits for it. That call throws what
/// make_backend() would throw.
[[nodiscard]] std::unique_ptr<BackendAhead> make_backend_ahead(const std::string& name,
                                                               const BackendOptions& options = {});

}  // namespace tandem
