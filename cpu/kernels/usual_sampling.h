/// For the file of a kernel that is for the sampler random and the filter box alone, and has both as constants.
/// Included before all other headers. With the choice at run time, whitted.gltf takes 1.06 times as long
/// (docs/performance.md, "CPU").
#pragma once

#define TANDEM_LINKED_SAMPLER 0U
#define TANDEM_LINKED_FILTER 0U
#define TANDEM_FACTS_TAG "_usual_sampling"

#include "cpu/kernels.h"

static_assert(static_cast<unsigned int>(tandem::usual_sampler) == TANDEM_LINKED_SAMPLER);
static_assert(static_cast<unsigned int>(tandem::usual_filter) == TANDEM_LINKED_FILTER);
