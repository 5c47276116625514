/// For the file of a kernel that is for the sampler random and the filter box alone, and has both as constants.
/// Included before all other headers. With a choice at run time, textured.gltf and whitted.gltf take 1.02 times as long
/// (docs/performance.md, "Before and after").
#pragma once

#define TANDEM_LINKED_SAMPLER 0U
#define TANDEM_LINKED_FILTER 0U
#define TANDEM_FACTS_TAG "_usual_sampling"

#include "cpu/kernels.h"

static_assert(static_cast<unsigned int>(tandem::usual_sampler) == TANDEM_LINKED_SAMPLER);
static_assert(static_cast<unsigned int>(tandem::usual_filter) == TANDEM_LINKED_FILTER);
