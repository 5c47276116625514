#include "tandem/math/lanes.h"
#include "unit/bsdf/lobe_lanes_body.h"

tandem::test::LobeRunners tandem::test::lobe_runners_v3() {
    return {lobe_runner<Lanes<float, Avx2>>(), lobe_runner<Lanes<double, Avx2>>()};
}
