#include "kernel/sampler/sampler_lanes_body.h"
#include "tandem/math/lanes.h"

tandem::test::SamplerRunner tandem::test::sampler_runner_v2() {
    using Packet = Lanes<float, Sse4>;
    return {Packet::size, run_sampler<Packet>};
}
