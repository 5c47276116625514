/// A job for tests that draw many scenes.
#pragma once

#include "tandem/render/render_job.h"

namespace tandem::test {

[[nodiscard]] inline RenderJob small_job(Tier tier = Tier::strict) {
    RenderJob job;
    job.tier = tier;
    job.width = 61;
    job.height = 43;
    job.samples = 4;
    job.seed = 3;
    return job;
}

}  // namespace tandem::test
