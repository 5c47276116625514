/// Limits the memory that a small file may cause.
#pragma once

#include <cstddef>
#include <string>

#include "tandem/gltf/buffers.h"

namespace tandem::gltf {

/// Counts what a short JSON text can multiply (one mesh at many nodes, one accessor in many channels), so that a small
/// file cannot fill the memory.
class Budget {
  public:
    /// The budget is five million elements, or as many as the file has bytes of data.
    explicit Budget(const Source& source);

    /// Refuses the file if the budget is exceeded.
    void spend(const Document& document, const std::string& json_path, std::size_t amount);

  private:
    std::size_t whole_;
    std::size_t left_;
};

}  // namespace tandem::gltf
