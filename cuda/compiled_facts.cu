// The facts of a render kernel that is linked when Tandem is built: for all scenes that have no effects but those of
// TANDEM_COMPILED_VARIANT and no primitives but TANDEM_COMPILED_KINDS (CMakeLists.txt). It renders if no kernel is
// linked at load.
#include "cuda/compiled_variants.h"
#include "cuda/linked_facts.h"
#include "tandem/kernel/traversal/constant_memory_tracer.h"
#include "tandem/kernel/traversal/instanced_tracer.h"

namespace tandem::cuda {

extern "C" {
extern __device__ const LinkedFacts tandem_facts;
__device__ const LinkedFacts tandem_facts =
    facts_of_any_scene(variants[TANDEM_COMPILED_VARIANT].effects, TANDEM_COMPILED_KINDS);
}

}  // namespace tandem::cuda
