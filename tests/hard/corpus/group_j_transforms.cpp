// Group J: transforms and animation.
#include <fmt/format.h>

#include <cmath>

#include "hard/corpus/functions.h"
#include "hard/corpus/groups.h"
#include "hard/corpus/pictures.h"
#include "hard/corpus/ray_batches.h"
#include "support/exact_geometry.h"
#include "support/under_parent.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/shapes/affine.h"
#include "tandem/scene/animation.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::hard {

namespace {

using test::any_unit;
using test::under_parent;

/// Ellipsoids of size 0.001 at a distance of a million; rays among them. Judged in object space.
std::vector<RayBatch> small_and_far(Random& random, std::size_t rays) {
    const Vec3d middle = {1e6, -1e6, 1e6};
    Scene scene = scene_of({});
    Node frame{.name = "frame"};
    frame.trs = {middle, {}, {1e-3, 1e-3, 1e-3}};
    scene.nodes.push_back(frame);
    std::vector<Vec3d> places;
    for (int i = 0; i < 64; ++i) {
        Node node{.name = "body", .parent = 1};
        const Vec3d place = any_unit(random) * random.uniform(0.0, 2000.0);
        node.trs = {place, test::any_turn(random), {100, 70, 50}};
        node.geometry.push_back({i % 2 == 0 ? Shape(SphereShape{1}) : BoxShape{}, 0, {}});
        scene.nodes.push_back(node);
        places.push_back(middle + place * 1e-3);
    }
    return {{scene, make_rays(rays, [&] {
                 const Vec3d origin = middle + any_unit(random) * 8.0;
                 const Vec3d target = places[random.below(64)] + any_unit(random) * 0.03;
                 return Ray<float>{narrow(origin), narrow(target - origin)};
             })}};
}

/// The normal of a sphere scaled to 1e-3 along z, against the exact gradient at the exact hit point.
Score pressed_normals(Random& random, std::size_t calls) {
    Scene scene = scene_of({});
    Node node{.name = "body"};
    node.trs.rotation = {0.1, 0.2, 0.3, 1};
    node.trs.scale = {1, 1, 1e-3};
    node.geometry.push_back({SphereShape{1}, 0, {}});
    scene.nodes.push_back(node);
    const Placement placement = prepare(scene).ellipsoids.at(0);
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const Vec3d target = any_unit(random) * 0.7;
        const Vec3d origin = any_unit(random) * 5.0;
        const Ray<float> ray = {narrow(origin), narrow(target - origin)};
        double t = 0;
        if (!first_hit<float>(ellipsoid_roots(placement, ray), t)) continue;
        const test::BigVector local =
            placement.object_from_world * (test::big(ray.origin) - test::big(placement.centre));
        const test::BigVector direction = placement.object_from_world * test::big(ray.direction);
        const auto right = test::hit_ball(local, direction, test::Big(1));
        if (!right) continue;
        const test::BigVector gradient = transpose(placement.object_from_world) * test::along(local, direction, *right);
        const test::Big length = sqrt(test::dot(gradient, gradient));
        const Vec3d normal = ellipsoid_normal(placement, ray, t);
        const test::BigVector off =
            test::big(normal) - test::BigVector{gradient.x / length, gradient.y / length, gradient.z / length};
        const double angle = static_cast<double>(sqrt(test::dot(off, off)));
        const auto line = [&] { return to_literal(ray); };
        score.decide(!(angle <= 1e-6), line);
        score.measure(angle * 0x1p24, line);
    }
    return score;
}

/// Flat solids are refused by name; a mirrored scene gives the mirror image.
Score determinants(Random&, std::size_t) {
    Score score;
    for (const double flat : {0.0, 1e-13, -1e-13, 1e-300}) {
        for (const bool is_box : {false, true}) {
            Scene scene = scene_of({});
            Node node{.name = "pressed"};
            node.trs.rotation = {0.3, 0.2, 0.1, 1};
            node.trs.scale = {1, 1, flat};
            node.geometry.push_back({is_box ? Shape(BoxShape{}) : SphereShape{1}, 0, {}});
            scene.nodes.push_back(node);
            bool refused = false;
            try {
                (void)prepare(scene);
            } catch (const InputError& error) {
                refused = std::string(error.what()).find("pressed") != std::string::npos;
            }
            score.decide(!refused, fmt::format("a body pressed to {} was taken", flat));
        }
    }
    const Scene straight = named_scene("mixed/64");
    Scene mirrored = straight;
    Node mirror{.name = "mirror"};
    mirror.trs.scale = {-1, 1, 1};
    const auto mirror_index = static_cast<std::int32_t>(mirrored.nodes.size());
    for (Node& node : mirrored.nodes) {
        if (node.parent == Node::no_parent) node.parent = mirror_index;
    }
    mirrored.nodes.push_back(mirror);
    const PreparedScene a = prepare(straight), b = prepare(mirrored);
    for (std::size_t i = 0; i < a.spheres.size(); ++i) {
        const Vec3f& p = a.spheres[i].centre;
        score.decide(b.spheres[i].centre != Vec3f{-p.x, p.y, p.z} || a.spheres[i].radius != b.spheres[i].radius,
                     fmt::format("sphere {} of the mirrored scene", i));
    }
    for (std::size_t i = 0; i < a.boxes.size(); ++i) {
        score.decide(b.boxes[i].lower.x != -a.boxes[i].upper.x || b.boxes[i].upper.y != a.boxes[i].upper.y,
                     fmt::format("box {} of the mirrored scene", i));
    }
    return score;
}

/// Frame n is at n / 24 seconds, rounded once, and what moves by 1 mm a frame has moved n mm.
Score clock_and_path(Random& random, std::size_t calls) {
    Scene scene = scene_of({{{0, 0, 0}, 1}});
    AnimationChannel channel;
    channel.node = 1;
    channel.times = {0, 1'000'000.0F};
    channel.values = {0, 0, 0, 24000, 0, 0};
    scene.animation = {channel};
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const auto frame = static_cast<std::int32_t>(random.below(24'000'000));
        const double time = time_of_frame(scene, frame);
        const auto line = [&] { return fmt::format("frame {} at {}", frame, time); };
        const Exact right = Exact(frame) / 24;
        score.measure(ulps_from(static_cast<float>(time), right), line);
        if (i % 16 != 0) continue;
        const double moved = parents_from_nodes(scene, time)[1].translation.x;
        const double expected = frame * 1e-3;
        score.decide(!(std::abs(moved - expected) <= 1e-6 * expected), line);
    }
    return score;
}

/// A rotation between keys stays a rotation at every frame; a quaternion and its negative are the same rotation.
Score rotations(Random& random, std::size_t calls) {
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        Scene scene = scene_of({{{0, 0, 0}, 1}});
        AnimationChannel channel;
        channel.node = 1;
        channel.path = AnimatedPath::rotation;
        channel.times = {0, 1};
        const Vec3d axis = any_unit(random);
        const double angle = i % 3 == 0 ? 0 : std::exp2(random.uniform(-30.0, 1.0));
        const double second_sign = random.coin() ? 1.0 : -1.0;
        const auto add = [&](double half, double sign) {
            for (const double part : {axis.x * std::sin(half), axis.y * std::sin(half), axis.z * std::sin(half)}) {
                channel.values.push_back(static_cast<float>(sign * part));
            }
            channel.values.push_back(static_cast<float>(sign * std::cos(half)));
        };
        add(0.3, 1);
        add(0.3 + angle / 2, second_sign);
        scene.animation = {channel};
        const double time = random.uniform(0.0, 1.0);
        const Matrix3 m = parents_from_nodes(scene, time)[1].linear;
        const double half = 0.3 + time * angle / 2;
        const Matrix3 right = rotation_matrix(
            {axis.x * std::sin(half), axis.y * std::sin(half), axis.z * std::sin(half), std::cos(half)});
        double off = 0;
        for (int k = 0; k < 3; ++k) {
            off = std::max(off, std::abs(dot(m.row[k], m.row[k]) - 1));
            off = std::max(off, norm1(m.row[k] - right.row[k]));
        }
        score.nans += std::isnan(off);
        score.decide(!(off <= 1e-6),
                     [&] { return fmt::format("angle {}, sign {}: off by {}", angle, second_sign, off); });
    }
    return score;
}

/// Frame 7 alone, and after six others.
Score frame_alone(const Subject& subject, Random&, std::size_t) {
    const Scene scene = named_scene("paper");
    Score score;
    const auto frame = [&](std::uint32_t number) {
        RenderJob job = small_picture(subject);
        job.frame = number;
        const PrepareOptions options = {.frame = static_cast<std::int32_t>(number), .camera = ""};
        return picture_of(subject.backend, prepare(scene, options), job, score);
    };
    const Film alone = frame(7);
    for (std::uint32_t number = 0; number < 7; ++number) (void)frame(number);
    compare_bits(frame(7), alone, "frame 7 after six others", score);
    return score;
}

/// Scene and camera 128 to 10^7 from where they were, by multiples of the step of the places where render space may
/// begin: no coordinate in it changes, but doubles far out are coarser. Every pixel to 2 10^-6.
Score far_away(const Subject& subject, Random& random, std::size_t) {
    Score score;
    for (const char* name : {"paper", "mixed/64", "triangles/64"}) {
        const Scene scene = named_scene(name);
        const Film right = picture_of(subject.backend, prepare(scene), small_picture(subject), score);
        for (const double distance : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
            const auto steps = [&] { return 64.0 * std::round(distance / 64 * random.uniform(-1.0, 1.0)); };
            const Vec3d by = {64.0 * std::round(distance / 64), steps(), steps()};
            const Film film =
                picture_of(subject.backend, prepare(under_parent(scene, by, 1)), small_picture(subject), score);
            const auto samples = static_cast<double>(film.samples());
            for (std::size_t i = 0; i < film.sums().size(); ++i) {
                const Vec3d off = film.sums()[i] - right.sums()[i];
                score.decide(!(norm1(off) <= 2e-6 * samples), [&] {
                    return fmt::format("{} moved by {}, {}, {}: pixel {} off by {}", name, by.x, by.y, by.z, i,
                                       norm1(off) / samples);
                });
            }
        }
    }
    return score;
}

/// Everything 2^k times as large, k from -40 to 40: the same picture, bit for bit.
Score powers_of_two(const Subject& subject, Random&, std::size_t) {
    Score score;
    const Scene scene = named_scene("mixed/64");
    const Film right = picture_of(subject.backend, prepare(scene), small_picture(subject), score);
    for (const int k : {-40, -13, -1, 1, 10, 27, 40}) {
        const Scene scaled = under_parent(scene, {0, 0, 0}, std::exp2(k));
        compare_bits(picture_of(subject.backend, prepare(scaled), small_picture(subject), score), right,
                     fmt::format("scaled by 2^{}", k), score);
    }
    return score;
}

/// The axes renamed, x to y to z to x: the same hits, t within the last bits, and exactly equal for boxes.
Score renamed_axes(const Subject& subject, Random& random, std::size_t count) {
    std::vector<Sphere> spheres[3];
    std::vector<Box> boxes[3];
    std::vector<Ray<float>> rays[3];
    const auto turned = [](const Vec3f& v, int by) { return Vec3f{v[by % 3], v[(by + 1) % 3], v[(by + 2) % 3]}; };
    for (int i = 0; i < 64; ++i) {
        const Vec3f centre = narrow(any_unit(random) * random.uniform(1.0, 10.0));
        const Vec3f corner = narrow(any_unit(random) * random.uniform(1.0, 10.0));
        const Vec3f size = {random.uniform(0.1F, 1.0F), random.uniform(0.1F, 1.0F), random.uniform(0.1F, 1.0F)};
        for (int by = 0; by < 3; ++by) {
            spheres[by].push_back({turned(centre, by), 0.5F});
            boxes[by].push_back({turned(corner, by), turned(corner + size, by)});
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f origin = narrow(any_unit(random) * 20.0);
        const Vec3f direction = narrow(any_unit(random) * 8.0) - origin;
        for (int by = 0; by < 3; ++by) rays[by].push_back({turned(origin, by), turned(direction, by)});
    }
    std::vector<Hit> hits[3];
    for (int by = 0; by < 3; ++by) {
        hits[by].resize(count);
        subject.backend.trace(
            *subject.backend.load(prepare(scene_of(spheres[by], boxes[by]), {.origin = Vec3d{0, 0, 0}}), subject.tier),
            TraceJob{.rays = rays[by], .hits = hits[by]});
    }
    Score score;
    for (std::size_t i = 0; i < count; ++i) {
        const auto line = [&] { return to_literal(rays[0][i]); };
        for (int by = 1; by < 3; ++by) {
            score.decide(hits[by][i].primitive != hits[0][i].primitive, line);
            if (hits[0][i].primitive != no_primitive) {
                score.measure(ulps_from(hits[by][i].t, double{hits[0][i].t}), line);
            }
        }
    }
    return score;
}

}  // namespace

std::vector<HardCase> transform_cases() {
    return {
        {"J1", "Scene and camera 10^2 to 10^7 from the origin", "floats are coarse there: t is off by 16 % at 10^7",
         "metamorphosis: the scene at the origin", RenderCase{far_away}},
        {"J2", "Solids of size 0.05 at 10^6, through three transforms",
         "an inverse in float is off by 107 units in object space: it multiplies before it subtracts",
         "exact arithmetic in object space", RayCase{small_and_far}},
        {"J3", "Normals of a sphere scaled by 1 : 1000",
         "the matrix is used instead of its inverse transpose: off by 1.57 rad", "exact arithmetic",
         FunctionCase{pressed_normals}},
        {"J4", "Determinants of 0, 10^-13 and below 0", "infinite normals, or inverted solids",
         "rule: refused with a reason; a mirror image", FunctionCase{determinants}},
        {"J5", "Time and position along a path, up to frame 24,000,000", "t += 1/24 is off by 2.9 s after 10^5 frames",
         "closed form", FunctionCase{clock_and_path}},
        {"J7", "Rotation between keys, of q and -q, and between equal keys",
         "errors of steps accumulate; acos(1 + u) is NaN", "closed form", FunctionCase{rotations}},
        {"J8", "A frame rendered alone and in sequence", "state from other frames remains", "metamorphosis: equal bits",
         RenderCase{frame_alone}},
        {"J10", "The scene scaled by 2^k, k from -40 to 40", "every absolute epsilon shows",
         "metamorphosis: equal bits", RenderCase{powers_of_two}},
        {"J11", "The axes permuted", "a comparison favours one axis", "metamorphosis: the same hits",
         RenderCase{renamed_axes}},
    };
}

}  // namespace tandem::hard
