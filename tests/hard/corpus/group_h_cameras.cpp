// Group H: camera rays and random numbers. There are no cases for lenses (H3, H4) yet.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "hard/corpus/functions.h"
#include "hard/corpus/groups.h"
#include "hard/corpus/ray_batches.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/camera/camera.h"
#include "tandem/kernel/sampler/dimensions.h"

namespace tandem::hard {

namespace {

Scene camera_scene(double yfov, const Quaternion& rotation) {
    Scene scene;
    Node eye{.name = "eye", .camera = PerspectiveCamera{yfov}};
    eye.trs.rotation = rotation;
    scene.nodes.push_back(eye);
    return scene;
}

/// The directions of 4096 pixels of a view of 1e-3 and 1e-4 degrees: all different, within 1e-3 of a pixel.
template <class Real>
void narrow_view(const Quaternion& rotation, Score& score) {
    constexpr int size = 4096;
    for (const double degrees : {1e-3, 1e-4}) {
        const CameraView view = camera_view(prepare(camera_scene(degrees * M_PI / 180, rotation)).camera, size, size);
        const double pixel = std::sqrt(dot(view.direction_dx, view.direction_dx));
        Vec3<Real> before = {2, 2, 2};
        for (int x = 0; x < size; ++x) {
            const Ray<Real> ray = camera_ray<Real>(view, x, size / 2, Real(0.5), Real(0.5));
            const auto line = [&] { return fmt::format("{} degrees, pixel {} of {}", degrees, x, size); };
            const Vec3d exact = view.direction + view.direction_dx * (x + 0.5) + view.direction_dy * (size / 2 + 0.5);
            const Vec3d off = cross(widen(ray.direction), exact);
            const double pixels = std::sqrt(dot(off, off)) / dot(exact, exact) / pixel;
            score.decide(ray.direction == before || !(pixels <= 1e-3), line);
            before = ray.direction;
        }
    }
}

/// In strict along an axis: turned, components of a float near 1 are 6e-8 apart, fourteen pixels of such a view.
Score narrow_views(Random&, std::size_t, Tier tier) {
    Score score;
    if (tier == Tier::precise) {
        narrow_view<double>({}, score);
        narrow_view<double>({0.3, 0.2, 0.1, 1}, score);
    } else {
        narrow_view<float>({}, score);
    }
    return score;
}

/// Cameras with singular transforms are refused; all others give finite rays and orthogonal axes.
Score degenerate_cameras(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        Scene scene = camera_scene(0.8, {});
        Matrix3 m;
        for (Vec3d& row : m.row) row = test::any_unit(random) * std::exp2(random.uniform(-8.0, 8.0));
        const bool degenerate = i % 4 == 0;
        if (degenerate) m.row[2] = i % 8 == 0 ? m.row[1] : Vec3d{0, 0, 0};
        if (i % 4 == 1) m.row[2] = m.row[1] * 0.5 + m.row[2] * 1e-6;  // almost
        scene.nodes[0].matrix = Transform{m, {0, 0, 0}};
        bool refused = false;
        CameraView view{};
        try {
            view = camera_view(prepare(scene).camera, 64, 64);
        } catch (const InputError&) {
            refused = true;
        }
        const auto finite = [](const Vec3d& v) { return std::isfinite(v.x + v.y + v.z) && dot(v, v) > 0; };
        const double skew = std::abs(dot(view.direction_dx, view.direction_dy));
        const bool good = finite(view.direction) && finite(view.direction_dx) && finite(view.direction_dy) &&
                          skew <= 1e-12 * dot(view.direction_dx, view.direction_dx);
        score.decide(degenerate ? !refused && !good : refused || !good, [&] {
            return fmt::format("camera matrix {} of the generator: {}, skew {}", i, refused ? "refused" : "taken",
                               skew);
        });
    }
    return score;
}

/// All upper 24 bits, with the lower ones all 0 or all 1: below 1, and exactly a multiple of 2^-24.
Score unit_interval(Random&, std::size_t) {
    Score score;
    for (std::uint32_t high = 0; high < 1U << 24; ++high) {
        const float least = to_unit_interval<float>(high << 8);
        const float most = to_unit_interval<float>(high << 8 | 255U);
        score.decide(!(most < 1 && least == most && double{least} == high * 0x1p-24),
                     [&] { return fmt::format("word {:#x}", high << 8); });
    }
    const auto many = to_unit_interval<Packet>(UInt<Packet>(0xFFFFFFFFU));
    score.decide(!(many[0] == 1 - 0x1p-24F), "a packet's greatest number");
    return score;
}

/// Rays of the last pixels of a film of 65,536: the jitter of a sample keeps its digits beside the pixel's number. The
/// error counts in units of the direction's largest component.
Score large_film(Random& random, std::size_t calls) {
    constexpr int size = 65536;
    const CameraView view = camera_view(prepare(camera_scene(0.8, {0.3, 0.2, 0.1, 1})).camera, size, size);
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const double x = size - 1.0 - random.below(4), y = size - 1.0 - random.below(4);
        const auto u = static_cast<float>(random.below(1U << 24)) * 0x1p-24F;
        const auto v = static_cast<float>(random.below(1U << 24)) * 0x1p-24F;
        const Ray<float> ray = camera_ray<float>(view, x, y, u, v);
        const Vec3d exact = view.direction + view.direction_dx * (x + double{u}) + view.direction_dy * (y + double{v});
        const double largest = std::max({std::abs(exact.x), std::abs(exact.y), std::abs(exact.z)});
        const Vec3d off = widen(ray.direction) - exact;
        const double place = std::exp2(std::floor(std::log2(largest)) - 23);
        const auto line = [&] { return fmt::format("pixel {}, {} offset {} {}", x, y, u, v); };
        score.decide(false, line);
        score.measure(std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) / place, line);
    }
    return score;
}

/// Blocks of counters around the limits of 32 bits: no two are equal.
Score counters(Random& random, std::size_t calls) {
    Score score;
    std::set<std::array<std::uint32_t, 4>> asked, given;
    const auto near_an_end = [&] {
        static constexpr std::uint32_t ends[] = {0, 1U << 20, 1U << 24, 1U << 31, 0xFFFFFFF0U};
        return ends[random.below(5)] + random.below(16);
    };
    const PhiloxKeys keys = philox_keys(7);
    for (std::size_t i = 0; i < calls; ++i) {
        const std::uint32_t pixel = near_an_end(), sample = near_an_end(), frame = near_an_end();
        const auto block = SampleId<float>{&keys, frame, pixel, sample}.block(Dimension::film);
        const bool is_new = asked.insert({pixel, sample, frame, 0}).second;
        const bool differs = given.insert({block.word[0], block.word[1], block.word[2], block.word[3]}).second;
        const auto many = SampleId<Packet>{&keys, frame, UInt<Packet>(pixel), sample}.block(Dimension::film);
        bool same = true;
        for (int k = 0; k < 4; ++k) same = same && many.word[k][3] == block.word[k];
        score.decide(is_new != differs || !same,
                     [&] { return fmt::format("pixel {}, sample {}, frame {}", pixel, sample, frame); });
    }
    return score;
}

/// The greatest offset within a pixel stays below 1 and does not pass the next pixel's border by more than the two
/// roundings of a direction: its owner is the whole number, which is never formed from the sum.
Score pixel_borders(Random& random, std::size_t calls) {
    Score score;
    for (const int size : {1, 100, 4096, 65536}) {
        const CameraView view = camera_view(prepare(camera_scene(0.8, {})).camera, size, size);
        for (std::size_t i = 0; i < calls / 4; ++i) {
            const double x = random.below(static_cast<std::uint32_t>(size));
            const float last = camera_ray<float>(view, x, 0, 1 - 0x1p-24F, 0).direction.x;
            const float next = camera_ray<float>(view, x + 1, 0, 0, 0).direction.x;
            const float first = camera_ray<float>(view, x, 0, 0, 0).direction.x;
            score.decide(!(first < last && double{last} <= double{next} + 0x1p-23),
                         [&] { return fmt::format("pixel {} of {}", x, size); });
        }
    }
    return score;
}

}  // namespace

std::vector<HardCase> camera_cases() {
    return {
        {"H1", "4096 pixels over 10^-3 and 10^-4 degrees", "a normalised direction in float has 66 values across them",
         "closed form in double", FunctionCase{narrow_views}},
        {"H2", "Cameras with parallel axes", "the basis is 0/0", "rule: refused, or an orthogonal basis",
         FunctionCase{degenerate_cameras}},
        {"H5", "Random bits to [0, 1)", "x 2^-32 rounds to 1 for 128 words", "exhaustive over 2^24",
         FunctionCase{unit_interval}},
        {"H9", "Jitter in a film 65,536 pixels wide", "pixel + jitter has only 256 positions within a pixel",
         "closed form in double", FunctionCase{large_film}},
        {"H10", "Counters at the ends of 32 bits", "a counter that wraps repeats its numbers",
         "no two blocks are equal", FunctionCase{counters}},
        {"H12", "Jitter at the edge of a pixel", "rounding carries a sample into the next pixel",
         "rule: half-open interval", FunctionCase{pixel_borders}},
    };
}

}  // namespace tandem::hard
