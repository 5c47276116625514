#include "kernel/sampler/sampler_lanes_body.h"
#include "tandem/math/lanes.h"

tandem::test::SamplerRunner tandem::test::sampler_runner_v3() {
    using Packet = Lanes<float, Avx2>;
    return {Packet::size, run_sampler<Packet>};
}
