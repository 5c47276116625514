#include "kernel/bsdf/lobe_lanes_body.h"
#include "tandem/math/lanes.h"

tandem::test::LobeRunners tandem::test::lobe_runners_v4() {
    return {lobe_runner<Lanes<float, Avx512>>(), lobe_runner<Lanes<double, Avx512>>()};
}
