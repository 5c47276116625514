/// The functions behind lobe_lanes.h, as templates over Real; also for nvcc.
#pragma once

#include "kernel/bsdf/lobe_examples.h"
#include "kernel/bsdf/lobe_lanes.h"
#include "tandem/math/fast_float.h"

namespace tandem::test {
namespace {

template <class Real>
struct LobeNumbers {
    using D = Double<Real>;
    Vec3<D> wo, wi, u;
    LobeParameters<Real> of_lobe;
};

/// T with make(i) in lane i.
template <class T, class Make>
TANDEM_HD T fill(Make make) {
    if constexpr (RealTraits<T>::lanes == 1) {
        return make(0);
    } else {
        // not by set(): g++ 12 takes that for a use of uninitialised lanes
        Scalar<T> numbers[T::size];
        for (int i = 0; i < T::size; ++i) numbers[i] = static_cast<Scalar<T>>(make(i));
        T value;
        std::memcpy(&value, numbers, sizeof value);
        return value;
    }
}

template <class Real>
TANDEM_HD LobeNumbers<Real> load(const LobeInput* in) {
    using D = Double<Real>;
    LobeNumbers<Real> result;
    for (int k = 0; k < 3; ++k) {
        result.wo[k] = fill<D>([=](int i) { return in[i].wo[k]; });
        result.wi[k] = fill<D>([=](int i) { return in[i].wi[k]; });
        result.u[k] = fill<D>([=](int i) { return in[i].u[k]; });
        result.of_lobe.colour[k] = to_real<Real>(fill<D>([=](int i) { return in[i].colour[k]; }));
    }
    for (int k = 0; k < 2; ++k) {
        result.of_lobe.roughness[k] = fill<D>([=](int i) { return in[i].roughness[k]; });
    }
    result.of_lobe.eta = fill<D>([=](int i) { return in[i].eta; });
    return result;
}

TANDEM_HD std::uint64_t bits_of_number(float v) { return bits_of(v); }
TANDEM_HD std::uint64_t bits_of_number(double v) { return bits_of(v); }
TANDEM_HD std::uint64_t bits_of_number(FastFloat v) { return bits_of(v); }
TANDEM_HD std::uint64_t bits_of_number(bool v) { return v ? 1 : 0; }

/// Writes the numbers of lobe number `at`, lane by lane.
template <class Real>
struct LobeWriter {
    LobeBits* out;
    int at;
    int place = 0;

    template <class T>
    TANDEM_HD void add(const T& value) {
        for (int i = 0; i < RealTraits<Real>::lanes; ++i) out[i].number[at][place] = bits_of_number(lane(value, i));
        ++place;
    }
    template <class T>
    TANDEM_HD void add(const Vec3<T>& v) {
        add(v.x);
        add(v.y);
        add(v.z);
    }
};

template <class Real, class L>
TANDEM_HD void run_lobe(const LobeNumbers<Real>& n, LobeBits* out, int at) {
    L lobe;
    make(n.of_lobe, lobe);
    LobeWriter<Real> to{out, at};
    to.add(lobe.f(n.wo, n.wi));
    to.add(lobe.pdf(n.wo, n.wi));
    to.add(lobe.albedo(n.wo));
    const LobeSample<Real> drawn = lobe.sample(n.wo, n.u);
    to.add(drawn.wi);
    to.add(drawn.pdf);
    to.add(drawn.weight);
    to.add(drawn.valid);
    to.add(drawn.transmits);
}

template <class Real>
TANDEM_HD void run_lobes(const LobeInput* in, LobeBits* out) {
    const LobeNumbers<Real> numbers = load<Real>(in);
    int at = 0;
#define TANDEM_LOBE(type, ...) run_lobe<Real, type<Real>>(numbers, out, at++);
#include "tandem/kernel/bsdf/lobes.def"
}

#if !TANDEM_COMPILING_CUDA
template <class Real>
LobeRunner lobe_runner() {
    return {RealTraits<Real>::lanes, [](const LobeInput* in, LobeBits* out) { run_lobes<Real>(in, out); }};
}
#endif

}  // namespace
}  // namespace tandem::test
