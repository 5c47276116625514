#include "kernel/bsdf/lobe_lanes_body.h"
#include "tandem/math/lanes.h"

tandem::test::LobeRunners tandem::test::lobe_runners_v2() {
    return {lobe_runner<Lanes<float, Sse4>>(), lobe_runner<Lanes<double, Sse4>>()};
}
