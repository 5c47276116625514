#include "tandem/math/lanes.h"
#include "unit/bsdf/lobe_lanes_body.h"

tandem::test::LobeRunners tandem::test::lobe_runners_v4() {
    return {lobe_runner<Lanes<float, Avx512>>(), lobe_runner<Lanes<double, Avx512>>()};
}
