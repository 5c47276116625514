/// tandem-render verify without its command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "render/scene_source.h"
#include "tandem/render/verify.h"

namespace tandem {

struct VerifyCommand {
    std::string image{};
    std::string scene{};        ///< empty: the one that the image names
    std::string environment{};  ///< the same
    VerifyOptions how{};
    bool quiet = false;
};

/// Draws tiles of the image again and prints the verdict. Returns the exit status: 0, or 1 if a pixel differs. Throws
/// as verify_image() does, with the image's name.
[[nodiscard]] int run_verify(const VerifyCommand& command, Backend& backend);

}  // namespace tandem
