/// Converts the environment that an author sets to the data that kernels read.
#pragma once

#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// The authored type of each kind of environment of lights.def has, in its header,
///
/// in_words(authored)         "a picture with 8 x 4 texels", for the reason of the effect
/// check(authored, require)   calls require(condition, where, problem) for each condition of a valid one: validate()
///
/// and, in a file environment_*.cpp of this folder, prepare_environment(), which sets the members and arrays of its
/// kind in the prepared scene. `authored` is valid. The result must be the same on every machine.
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) \
    void prepare_environment(const Authored& authored, PreparedScene& scene);
#include "tandem/kernel/lights/lights.def"

}  // namespace tandem
