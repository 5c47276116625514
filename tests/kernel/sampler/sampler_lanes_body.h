/// Included by one file for each instruction set, and by the test for single rays.
#pragma once

#include "kernel/sampler/sampler_lanes.h"
#include "tandem/kernel/light_reservoir.h"
#include "tandem/kernel/pixel.h"

namespace tandem::test {

template <class Real>
void run_sampler(const SamplerInput* in, std::uint32_t (*numbers)[10]) {
    using Word = UInt<Real>;
    constexpr int lanes = RealTraits<Real>::lanes;
    Word x(0U), y(0U), sample(0U), vertex(0U);
    for (int i = 0; i < lanes; ++i) {
        set_lane(x, i, in[i].x);
        set_lane(y, i, in[i].y);
        set_lane(sample, i, in[i].sample);
        set_lane(vertex, i, in[i].vertex);
    }
    PixelJob job{};
    job.keys = philox_keys(in->seed);
    job.sampler = make_job_sampler(static_cast<Sampler>(in->kind), in->seed, in->frame);
    job.frame = in->frame;
    job.film_width = 65536;
    const SampleId<Real> id = sample_of<Real>(job, x, y, sample);
    const auto block = id.block(static_cast<Dimension>(in->dimension), vertex);
    const Vec2<Real> offset =
        sample_filter<Real>(static_cast<PixelFilter>(in->filter), to_unit_interval<Real>(block.word[0]),
                            to_unit_interval<Real>(block.word[1]));
    const auto light = light_choice<Real>(id, vertex);
    for (int i = 0; i < lanes; ++i) {
        for (int k = 0; k < 4; ++k) {
            numbers[i][k] = lane(block.word[k], i);
            numbers[i][4 + k] = lane(light.word[k], i);
        }
        numbers[i][8] = bits_of(lane(offset.x, i));
        numbers[i][9] = bits_of(lane(offset.y, i));
    }
}

}  // namespace tandem::test
