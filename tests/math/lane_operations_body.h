/// The operations behind lane_operations.h, as templates over Real.
#pragma once

#include "math/lane_operations.h"
#include "tandem/kernel/lights/environment_picture.h"
#include "tandem/kernel/lights/quad_light.h"
#include "tandem/kernel/lights/sphere_light.h"
#include "tandem/kernel/roulette.h"
#include "tandem/kernel/sampler/mis.h"
#include "tandem/kernel/sampler/philox.h"
#include "tandem/kernel/sampler/warp.h"
#include "tandem/kernel/shapes/parametrisation.h"
#include "tandem/kernel/shapes/quad.h"
#include "tandem/kernel/texture/texture_view.h"
#include "tandem/kernel/traversal/intersect.h"
#include "tandem/math/exact_math.h"
#include "tandem/math/lanes.h"
#include "tandem/math/lookup_table.h"
#include "tandem/math/pick_lanes.h"

namespace tandem::test {
namespace {

template <class Real>
struct Slots {
    using F = Float<Real>;
    using D = Double<Real>;
    using U = UInt<Real>;
    using I = UInt64<Real>;
    using M = Mask<Real>;
    static constexpr int lanes = RealTraits<Real>::lanes;

    template <class T, class Scalar, class Make>
    TANDEM_HD static T fill(Make make) {
        if constexpr (lanes == 1) {
            return make(0);
        } else {
            T value;
            for (int i = 0; i < lanes; ++i) value.set(i, static_cast<Scalar>(make(i)));
            return value;
        }
    }
    template <class T>
    TANDEM_HD static auto lane(const T& value, int i) {
        if constexpr (lanes == 1) {
            return value;
        } else {
            return value[i];
        }
    }

    // One overload per type, by a tag, so that an operation says only F, D, U or I.
    TANDEM_HD static void load(const std::uint64_t* p, F& v) {
        v = fill<F, float>([&](int i) { return float_of(static_cast<std::uint32_t>(p[i])); });
    }
    TANDEM_HD static void load(const std::uint64_t* p, D& v) {
        v = fill<D, double>([&](int i) { return double_of(p[i]); });
    }
    TANDEM_HD static void load(const std::uint64_t* p, U& v) {
        v = fill<U, std::uint32_t>([&](int i) { return static_cast<std::uint32_t>(p[i]); });
    }
    TANDEM_HD static void load(const std::uint64_t* p, I& v) {
        v = fill<I, std::uint64_t>([&](int i) { return p[i]; });
    }

    // The bits of a NaN are nobody's promise.
    TANDEM_HD static std::uint64_t bits(float v) { return v != v ? 0x7FC00000U : bits_of(v); }
    TANDEM_HD static std::uint64_t bits(double v) { return v != v ? 0x7FF8000000000000U : bits_of(v); }
    TANDEM_HD static std::uint64_t bits(std::uint32_t v) { return v; }
    TANDEM_HD static std::uint64_t bits(std::uint64_t v) { return v; }
    TANDEM_HD static std::uint64_t bits(bool v) { return v ? 1U : 0U; }

    template <class T>
    TANDEM_HD static void store(const T& value, std::uint64_t* out) {
        for (int i = 0; i < lanes; ++i) out[i] = bits(lane(value, i));
    }
};

template <class Real>
TANDEM_HD UInt<Real> high_word(const UInt<Real>& a, const UInt<Real>& b) {
    UInt<Real> high, low;
    multiply_wide(a, b, high, low);
    return high;
}
template <class Real>
TANDEM_HD UInt<Real> low_word(const UInt<Real>& a, const UInt<Real>& b) {
    UInt<Real> high, low;
    multiply_wide(a, b, high, low);
    return low;
}

/// The bodies and the faces between them use most of what geometry does.
template <class Real, class ShadingFrame>
TANDEM_HD Double<Real> first_parameter(const ShadingFrame& meeting) {
    Double<Real> t;
    const auto hit = first_hit<Real>(meeting, t);
    return select(hit, t, Double<Real>(-1.0));
}
template <class Real, class Primitive>
TANDEM_HD Double<Real> first_parameter(const Primitive& primitive, const Ray<Real>& ray) {
    Double<Real> t;
    const auto hit = first_hit(primitive, ray, t);
    return select(hit, t, Double<Real>(-1.0));
}
template <class Real>
TANDEM_HD Ray<Real> ray_of(const Real& a, const Real& b, const Real& c) {
    const Real two(2.0F);
    return {{b, c - two, a}, {c - a, two - b, a + b}};
}

template <class Real>
TANDEM_HD FilterRay<Real> filter_ray(const float* ray) {
    return make_filter_ray(
        Ray<Real>{{Real(ray[0]), Real(ray[1]), Real(ray[2])}, {Real(ray[3]), Real(ray[4]), Real(ray[5])}});
}
template <class Real>
bool lanes_may_touch_sphere(const float* sphere, const float* ray) {
    const auto f = filter_ray<Real>(ray);
    const Vec3f centre = {sphere[0], sphere[1], sphere[2]};
    return all(may_touch_sphere(f, centre, sphere[3]) && !is_behind_sphere(f, centre, sphere[3]));
}
template <class Real>
bool lanes_may_touch_box(const float* box, const float* ray) {
    return all(may_touch_box(filter_ray<Real>(ray), {box[0], box[1], box[2]}, {box[3], box[4], box[5]}));
}
template <class Real>
bool lanes_may_touch_triangle(const float* v, const float* ray) {
    return all(may_touch_triangle(filter_ray<Real>(ray), {v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}));
}
/// Small enough that rays of small numbers, and of zeros, meet its edges and its plane.
template <class Real>
TANDEM_HD Double<Real> barycentric_sum(const Triangle& t, const Ray<Real>& ray) {
    const auto at = barycentrics(t.v0, t.v1, t.v2, ray, Mask<Real>(true));
    return at.u + at.v * at.v;
}
/// A number of [0, 1] that hangs on a.
template <class D>
TANDEM_HD D uniform(const D& a) {
    return D(1.0) / (D(1.0) + a * a);
}
/// A picture of 3 x 2, with tables that need not fit it.
TANDEM_HD EnvironmentPictureView small_sky() {
    static constexpr float texels[] = {1, 2, 3, 0.5F, 0, 4, 0, 0, 0, 7, 1, 1e-3F, 2, 2, 2, 1e6F, 3, 5};
    static constexpr double borders[] = {0, 0.25, 0.75};
    static constexpr std::uint32_t band_ends[] = {1U << 28, 1U << 30, 1U << 31};
    static constexpr std::uint32_t cell_ends[] = {1U << 20, 1U << 30, 1U << 31, 0,       1U << 29,
                                                  1U << 31, 1U << 30, 1U << 30, 1U << 31};
    return {{0.3, 3, 2, 1.5F}, reinterpret_cast<const Vec3f*>(texels), borders, band_ends, cell_ends};
}
template <class Real>
TANDEM_HD Double<Real> environment(const Double<Real>& a, const Double<Real>& b, const Double<Real>& c) {
    const auto sight = see_environment<Real>(small_sky(), {a, b, c});
    const Vec3<Double<Real>> seen = widen(sight.radiance);
    return ((seen.x + seen.y) + seen.z) * sight.pdf;
}
template <class Real>
TANDEM_HD Float<Real> environment_sample(const UInt<Real>& a, const UInt<Real>& b, const UInt<Real>& c) {
    const auto sample = sample_environment<Real>(small_sky(), {{a, b, c, a ^ (b << 3)}});
    const auto direction = (sample.direction.x + sample.direction.y * sample.direction.z) + sample.pdf;
    return narrow(direction) + norm1(narrow(sample.radiance));
}
/// All that a light gives, as one number.
template <class Real, class View>
TANDEM_HD Double<Real> light_sum(const View& view, const Double<Real>& u, const Double<Real>& v) {
    const auto s = sample_light(view, uniform(u), uniform(v));
    const auto sum = (s.direction.x + s.direction.y * s.direction.z) + (s.point.x + s.point.y * s.point.z);
    return (sum + s.distance) + (s.pdf + pdf_of(view, s.direction)) * view.solid_angle;
}
template <class D>
TANDEM_HD Vec3<D> corner(double x, double y, double z) {
    return {D(x), D(y), D(z)};
}
template <class Real>
TANDEM_HD Double<Real> sphere_light(const Double<Real>& a, const Double<Real>& b, const Double<Real>& c) {
    using D = Double<Real>;
    return light_sum<Real>(view_sphere_light<Real>({a, b, D(0.0)}, corner<D>(1, 0.5, 0), D(1.5)), b, c);
}
template <class Real>
TANDEM_HD Double<Real> quad_light(const Double<Real>& a, const Double<Real>& b, const Double<Real>& c) {
    using D = Double<Real>;
    const auto view = view_quad_light<Real>({a, b, D(0.0)}, corner<D>(-1, 0, 0), corner<D>(1, -1, 0),
                                            corner<D>(1, 1, 0.5), corner<D>(-1, 2, 1));
    return light_sum<Real>(view, b, c);
}
template <class Real>
TANDEM_HD Double<Real> warp_sum(const Double<Real>& a, const Double<Real>& b) {
    using D = Double<Real>;
    const D u = uniform(a), v = uniform(b);
    const auto lens = sample_aperture<Real>(7, D(0.1), u, v);
    const auto disk = sample_aperture<Real>(0, D(0.1), u, v);
    const auto sphere = sample_sphere<Real>(u, v);
    const auto up = sample_cosine_hemisphere<Real>(sphere.direction, v, u);
    return (lens.x * lens.y + disk.x * disk.y) + (up.direction.x + up.direction.y * up.direction.z) * up.pdf;
}

/// The lanes counted from the last one.
template <class Real>
TANDEM_HD UInt<Real> from_end() {
    using Word = UInt<Real>;
    return Word::from([](int i) { return static_cast<std::uint32_t>(Real::size - 1 - i); });
}
/// The lanes of `a` the other way round.
template <class Real, class T>
TANDEM_HD T reversed(const T& a) {
    return T::from([&](int i) { return a[Real::size - 1 - i]; });
}
template <class Real>
TANDEM_HD Mask<Real> reversed(const Mask<Real>& a) {
    const UInt<Real> one(1U);
    return reversed<Real>(select(a, one, UInt<Real>(0U))) == one;
}
/// `a` by way of memory, where its lanes lie the other way round.
template <class Real, class T>
TANDEM_HD T gathered(const T& a) {
    if constexpr (RealTraits<Real>::lanes == 1) {
        return a;
    } else {
        const T memory = reversed<Real>(a);
        return T::gather(&memory, from_end<Real>() * UInt<Real>(static_cast<std::uint32_t>(sizeof(a[0]))));
    }
}
/// a < b by way of two masks in memory: of lanes the other way round and, where `second`, of the second mask.
template <class Real>
TANDEM_HD Mask<Real> gathered_less(const UInt<Real>& a, const UInt<Real>& b, const UInt<Real>& second) {
    if constexpr (RealTraits<Real>::lanes == 1) {
        return a < b;
    } else {
        using Word = UInt<Real>;
        const Mask<Real> less = reversed<Real>(a < b);
        const Mask<Real> is_second = reversed<Real>(second != Word(0U));
        // each lane is right in one of the two only
        const Mask<Real> masks[3] = {less != is_second, less != !is_second, is_second};
        const Word packet = select(second != Word(0U), Word(static_cast<std::uint32_t>(sizeof(masks[0]))), Word(0U));
        return gather_mask(&masks[0], packet, from_end<Real>());
    }
}

/// `a` by way of a register, where its lanes lie the other way round.
template <class Real>
TANDEM_HD UInt<Real> permuted(const UInt<Real>& a) {
    if constexpr (RealTraits<Real>::lanes == 1) {
        return a;
    } else {
        return permute(reversed<Real>(a), from_end<Real>());
    }
}
/// lanes_before() less the number that counting one lane after the other gives: 0.
template <class Real>
TANDEM_HD UInt<Real> miscounted_before(const Mask<Real>& mask) {
    if constexpr (RealTraits<Real>::lanes == 1) {
        return 0U;
    } else {
        std::uint32_t count = 0;
        return lanes_before(mask) - UInt<Real>::from([&](int i) { return mask[i] ? count++ : count; });
    }
}

/// The entry of a table with two rows, by any words.
template <class Real, class T>
TANDEM_HD auto looked_up(const UInt<Real>& a, const UInt<Real>& b) {
    using Word = UInt<Real>;
    static constexpr T numbers[] = {3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5, 8, 9, 7, 9, 3};
    const LookupTable<T> whole = {numbers, 8, 2};
    const LookupTable<T, 2> every_second = {numbers, 4, 2};
    return whole.at(a & Word(1U), b & Word(7U)) + every_second.at(b & Word(1U), a & Word(3U));
}

/// `a` by way of the packets in memory whose numbers are those of `packet` modulo pick_packets, where lanes lie the
/// other way round among those of `other`.
template <class Real, class T>
TANDEM_HD T picked(const T& a, const T& other, const UInt<Real>& packet) {
    if constexpr (RealTraits<Real>::lanes == 1) {
        return a;
    } else {
        using Word = UInt<Real>;
        struct Packet {
            T value;
            Word gap;
        };
        const Word number = packet & Word(pick_packets - 1U);
        const Word place = number * Word(static_cast<std::uint32_t>(Real::size)) + from_end<Real>();
        Packet packets[pick_packets];
        for (std::uint32_t k = 0; k < pick_packets; ++k) {
            const T values = select(number == Word(k), a, other);
            packets[k].value = reversed<Real>(values);
            packets[k].gap = number;
        }
        return pick<sizeof(Packet)>(packets[0].value, place);
    }
}

/// A picture of 3 x 2 texels; the levels need no meaning here.
template <class Real>
TANDEM_HD Float<Real> sampled(const Double<Real>& u, const Double<Real>& v) {
    static constexpr std::uint32_t texels[] = {0x01020304U, 0x05060700U, 0x00010203U, 0x07060504U, 0x03020100U, 1U};
    static constexpr float levels[] = {0.0F, 0.3F, 0.7F, 0.1F, 1.0F, 0.2F, 0.6F, 0.9F};
    const TextureView view = {texels, levels, 3, 2, Wrap::repeat, Wrap::mirrored_repeat, Filter::linear};
    const Rgba<Real> value = sample<Real>(view, u, v);
    return (value.r + value.g) + (value.b + value.a);
}
template <class Real>
TANDEM_HD Double<Real> globe(const Double<Real>& x, const Double<Real>& y, const Double<Real>& z) {
    const auto at = parametrisation_detail::on_globe<Real>(Vec3<Double<Real>>{x, y, z});
    return at.u + at.v;
}

#define TANDEM_LANE_OPERATIONS(OPERATION)                                                                            \
    OPERATION(F, add, a + b)                                                                                         \
    OPERATION(F, subtract, a - b)                                                                                    \
    OPERATION(F, multiply, a* b)                                                                                     \
    OPERATION(F, divide, a / b)                                                                                      \
    OPERATION(F, negate, -a)                                                                                         \
    OPERATION(F, absolute, absolute(a))                                                                              \
    OPERATION(F, square_root, square_root(a))                                                                        \
    OPERATION(F, lesser, lesser(a, b))                                                                               \
    OPERATION(F, greater, greater(a, b))                                                                             \
    OPERATION(F, less, a < b)                                                                                        \
    OPERATION(F, less_equal, a <= b)                                                                                 \
    OPERATION(F, more, a > b)                                                                                        \
    OPERATION(F, more_equal, a >= b)                                                                                 \
    OPERATION(F, equal, a == b)                                                                                      \
    OPERATION(F, not_equal, a != b)                                                                                  \
    OPERATION(F, select, select(a < b, b, c))                                                                        \
    OPERATION(F, widen, widen(a))                                                                                    \
    OPERATION(F, pick, picked<Real>(a, b, bits_of(c)))                                                               \
    OPERATION(F, to_wide, to_wide(a))                                                                                \
    OPERATION(F, to_word, to_word(select(absolute(a) < F(0x1p30F), absolute(a), F(7.0F))))                           \
    OPERATION(F, bits_of, bits_of(a))                                                                                \
    OPERATION(F, masks, ((a < b || !(b < c)) && a != c) != (c < a))                                                  \
    OPERATION(F, any_all, (Mask<Real>(any(a < b)) || !(a < b)) && (!Mask<Real>(all(a < b)) || a < b))                \
    OPERATION(D, add, a + b)                                                                                         \
    OPERATION(D, subtract, a - b)                                                                                    \
    OPERATION(D, multiply, a* b)                                                                                     \
    OPERATION(D, divide, a / b)                                                                                      \
    OPERATION(D, negate, -a)                                                                                         \
    OPERATION(D, absolute, absolute(a))                                                                              \
    OPERATION(D, square_root, square_root(a))                                                                        \
    OPERATION(D, lesser, lesser(a, b))                                                                               \
    OPERATION(D, greater, greater(a, b))                                                                             \
    OPERATION(D, less, a < b)                                                                                        \
    OPERATION(D, less_equal, a <= b)                                                                                 \
    OPERATION(D, more, a > b)                                                                                        \
    OPERATION(D, more_equal, a >= b)                                                                                 \
    OPERATION(D, equal, a == b)                                                                                      \
    OPERATION(D, not_equal, a != b)                                                                                  \
    OPERATION(D, select, select(a < b, b, c))                                                                        \
    OPERATION(D, narrow, narrow(a))                                                                                  \
    OPERATION(D, to_word, to_word(select(absolute(a) < D(0x1p30), absolute(a), D(7.0))))                             \
    OPERATION(D, bits_of, bits_of(a))                                                                                \
    OPERATION(D, multiply_add, multiply_add(a, b, c))                                                                \
    OPERATION(D, round_to_int, round_to_int(a))                                                                      \
    OPERATION(D, gather, gathered<Real>(a))                                                                          \
    OPERATION(D, pick, picked<Real>(a, b, bits_of(narrow(c))))                                                       \
    OPERATION(D, log_wide, log_wide<Real>(select(absolute(a) >= D(0x1p-1022), absolute(a), D(3.0))))                 \
    OPERATION(D, exp_wide, exp_wide<Real>(a))                                                                        \
    OPERATION(D, power, power<Real>(select(absolute(a) >= D(0x1p-1022), absolute(a), D(0.0)), absolute(b)))          \
    OPERATION(D, sample, sampled<Real>(a, b))                                                                        \
    OPERATION(D, globe, globe<Real>(a, b, c))                                                                        \
    OPERATION(U, add, a + b)                                                                                         \
    OPERATION(U, subtract, a - b)                                                                                    \
    OPERATION(U, multiply, a* b)                                                                                     \
    OPERATION(U, bit_and, a& b)                                                                                      \
    OPERATION(U, bit_or, a | b)                                                                                      \
    OPERATION(U, bit_xor, a ^ b)                                                                                     \
    OPERATION(U, left, a << 7)                                                                                       \
    OPERATION(U, right, a >> 9)                                                                                      \
    OPERATION(U, less, a < b)                                                                                        \
    OPERATION(U, equal, (a & U(3U)) == (b & U(3U)))                                                                  \
    OPERATION(U, select, select(a < b, b, c))                                                                        \
    OPERATION(U, gather, gathered<Real>(a))                                                                          \
    OPERATION(U, pick, picked<Real>(a, b, c))                                                                        \
    OPERATION(U, pick_mask, picked<Real>(a < b, b < a, c))                                                           \
    OPERATION(U, permute, permuted<Real>(a))                                                                         \
    OPERATION(U, lanes_before, miscounted_before<Real>(a < b))                                                       \
    OPERATION(U, gather_mask, gathered_less<Real>(a, b, c & U(1U)))                                                  \
    OPERATION(U, table_of_floats, (looked_up<Real, float>(a, b)))                                                    \
    OPERATION(U, table_of_doubles, (looked_up<Real, double>(a, b)))                                                  \
    OPERATION(U, table_of_words, (looked_up<Real, std::uint32_t>(a, b)))                                             \
    OPERATION(U, to_wide, to_wide(a))                                                                                \
    OPERATION(U, float_of, float_of(a))                                                                              \
    OPERATION(U, to_float, to_float(a >> 1))                                                                         \
    OPERATION(U, high_word, high_word<Real>(a, b))                                                                   \
    OPERATION(U, low_word, low_word<Real>(a, b))                                                                     \
    OPERATION(U, reversed_bits, reversed_bits(a))                                                                    \
    OPERATION(U, philox, (philox4x32<U>({{a, b, c, a}}, 17U, 23U).word[2]))                                          \
    OPERATION(U, unit_interval, to_unit_interval<Real>(a))                                                           \
    OPERATION(I, add, a + b)                                                                                         \
    OPERATION(I, subtract, a - b)                                                                                    \
    OPERATION(I, bit_and, a& b)                                                                                      \
    OPERATION(I, bit_or, a | b)                                                                                      \
    OPERATION(I, bit_xor, a ^ b)                                                                                     \
    OPERATION(I, left, a << 13)                                                                                      \
    OPERATION(I, right, a >> 52)                                                                                     \
    OPERATION(I, equal, (a & I(3)) == (b & I(3)))                                                                    \
    OPERATION(I, select, select(a == (b & I(~1ULL)), b, c))                                                          \
    OPERATION(I, double_of, double_of(a))                                                                            \
    OPERATION(F, exact_sin, exact_sin(a))                                                                            \
    OPERATION(F, exact_cos, exact_cos(a))                                                                            \
    OPERATION(F, exact_exp, exact_exp(a))                                                                            \
    OPERATION(F, exact_log, exact_log(a))                                                                            \
    OPERATION(F, exact_pow, exact_pow(a, b))                                                                         \
    OPERATION(F, sphere, first_parameter<Real>(sphere_roots(Sphere{{1, 2, -1}, 3}, ray_of(a, b, c))))                \
    OPERATION(F, sphere_hit, first_parameter<Real>(Sphere{{1, 2, -1}, 3}, ray_of(a, b, c)))                          \
    OPERATION(F, box, first_parameter<Real>(cross_box(Box{{-1, 0, 1}, {1, 1, 1}}, ray_of(a, b, c))))                 \
    OPERATION(F, triangle, first_parameter<Real>(Triangle{{1, 2, -1}, {-3, 0, 1}, {0, -4, 0}}, ray_of(a, b, c)))     \
    OPERATION(F, barycentrics, barycentric_sum<Real>(Triangle{{1, 2, -1}, {-3, 0, 1}, {0, -4, 0}}, ray_of(a, b, c))) \
    OPERATION(F, quad, first_parameter<Real>(Quad{{1, 2, -1}, {-3, 0, 1}, {0, -4, 0}, {2, -3, 1}}, ray_of(a, b, c))) \
    OPERATION(D, inverse_square_root, inverse_square_root(select(absolute(a) >= D(0x1p-1022), absolute(a), D(2.0)))) \
    OPERATION(D, difference_of_products, difference_of_products(a, b, c, a))                                         \
    OPERATION(D, sine_of_turns, sin_cos_turns<Real>(a).sine)                                                         \
    OPERATION(D, cosine_of_turns, sin_cos_turns<Real>(a).cosine)                                                     \
    OPERATION(D, atan2_turns, atan2_turns<Real>(a, b))                                                               \
    OPERATION(D, warp, warp_sum<Real>(a, b))                                                                         \
    OPERATION(D, sphere_light, sphere_light<Real>(a, b, c))                                                          \
    OPERATION(D, quad_light, quad_light<Real>(a, b, c))                                                              \
    OPERATION(D, environment, environment<Real>(a, b, c))                                                            \
    OPERATION(U, environment_sample, bits_of(environment_sample<Real>(a, b, c)))                                     \
    OPERATION(D, mis, balance_heuristic(a, b) + power_heuristic(b, c))                                               \
    OPERATION(D, survives, survives<Real>(survival_probability(Vec3<D>{a, b, c}, D(0.05)), uniform(a)))

#define TANDEM_DEFINE_OPERATION(Type, name, expression)                                           \
    template <class Real>                                                                         \
    void Type##_##name(const std::uint64_t* pa, const std::uint64_t* pb, const std::uint64_t* pc, \
                       std::uint64_t* out) {                                                      \
        using F [[maybe_unused]] = typename Slots<Real>::F;                                       \
        using D [[maybe_unused]] = typename Slots<Real>::D;                                       \
        using U [[maybe_unused]] = typename Slots<Real>::U;                                       \
        using I [[maybe_unused]] = typename Slots<Real>::I;                                       \
        Type a, b, c;                                                                             \
        Slots<Real>::load(pa, a);                                                                 \
        Slots<Real>::load(pb, b);                                                                 \
        Slots<Real>::load(pc, c);                                                                 \
        Slots<Real>::store(expression, out);                                                      \
    }
TANDEM_LANE_OPERATIONS(TANDEM_DEFINE_OPERATION)
#undef TANDEM_DEFINE_OPERATION

template <class Real>
LaneOperations all_operations() {
#define TANDEM_LIST_OPERATION(Type, name, expression) {#Type " " #name, &Type##_##name<Real>},
    static constexpr LaneOperation table[] = {TANDEM_LANE_OPERATIONS(TANDEM_LIST_OPERATION)};
#undef TANDEM_LIST_OPERATION
    return {table,
            sizeof(table) / sizeof(table[0]),
            RealTraits<Real>::lanes,
            &lanes_may_touch_sphere<Real>,
            &lanes_may_touch_box<Real>,
            &lanes_may_touch_triangle<Real>};
}

}  // namespace
}  // namespace tandem::test
