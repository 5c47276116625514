/// The performance targets.
#pragma once

#include <functional>
#include <vector>

#include "target_run.h"
#include "targets.h"

namespace tandem::bench {

/// A target: what it needs and how it is measured.
struct Target {
    TargetResult description;
    int needed_gpus = 0;
    std::function<void(TargetRun&, TargetResult&)> measure;
};

/// For a machine with `cores` cores.
[[nodiscard]] std::vector<Target> all_targets(int cores);

}  // namespace tandem::bench
