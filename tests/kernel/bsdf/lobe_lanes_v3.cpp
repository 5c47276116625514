#include "kernel/bsdf/lobe_lanes_body.h"
#include "tandem/math/lanes.h"

tandem::test::LobeRunners tandem::test::lobe_runners_v3() {
    return {lobe_runner<Lanes<float, Avx2>>(), lobe_runner<Lanes<double, Avx2>>()};
}
