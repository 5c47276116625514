/// A pending frame that is already rendered, for backends that render synchronously.
#pragma once

#include <utility>

#include "tandem/render/backend.h"

namespace tandem {

class ReadyFrame : public PendingFrame {
  public:
    explicit ReadyFrame(RenderResult result) : result_(std::move(result)) {}
    RenderResult get() override { return std::move(result_); }

  private:
    RenderResult result_;
};

}  // namespace tandem
