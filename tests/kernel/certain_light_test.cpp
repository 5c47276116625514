// What certain_hit() and certain_light() are certain of has the bits of the general code.
#include "tandem/kernel/certain_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/certain_pixel.h"

namespace tandem {
namespace {

using NoEffects = EffectSet<0>;

constexpr std::uint32_t film_size = 32;

PunctualLight light_at(const Vec3f& position, const Vec3f& intensity) {
    PunctualLight light{};
    light.direction = {0, 0, -1};
    light.position = position;
    light.intensity = intensity;
    light.kind = PunctualKind::point;
    return light;
}

/// solids in front of a camera at `eye` that looks along -z, near and far, some of them in contact, and lights among
/// them.
PreparedScene random_scene(test::Random& random, const Vec3d& eye) {
    PreparedScene scene;
    const auto colour = [&] {
        const auto part = [&] { return random.below(5) == 0 ? 0.0F : random.uniform(0.0F, 1.0F); };
        return Vec3f{part(), part(), part()};
    };
    const auto place = [&](double depth) {
        return narrow(eye + Vec3d{random.uniform(-0.7, 0.7) * depth, random.uniform(-0.7, 0.7) * depth, -depth});
    };
    const auto depth = [&] { return std::exp2(random.uniform(-1.0, 5.0)); };
    for (std::uint32_t i = 0, count = random.below(7); i < count; ++i) {
        const double z = depth();
        scene.spheres.push_back({place(z), static_cast<float>(z * std::exp2(random.uniform(-9.0, -1.3)))});
    }
    for (std::uint32_t i = 0, count = 1 + random.below(4); i < count; ++i) {
        const double z = depth();
        const Vec3f lower = place(z);
        const auto size = [&] { return static_cast<float>(z * std::exp2(random.uniform(-9.0, -1.3))); };
        scene.boxes.push_back({lower, lower + Vec3f{size(), size(), size()}});
    }
    for (std::size_t i = 0; i < scene.spheres.size() + scene.boxes.size(); ++i) {
        const auto shininess = random.coin() ? 32U : 1 + random.below(random.coin() ? 8 : 1024);
        scene.materials.push_back({colour(), colour(), colour(), static_cast<float>(shininess)});
        scene.optics.emplace_back();
        scene.material_of.push_back(static_cast<std::uint32_t>(i));
    }
    for (std::uint32_t i = 0, count = random.below(4); i < count; ++i) {
        scene.lights.push_back(light_at(place(depth() * 0.7), colour()));
    }
    scene.environment.ambient = colour();
    return scene;
}

PixelJob random_job(test::Random& random, const Vec3d& eye) {
    PixelJob job{};
    job.keys = philox_keys(random.bits());
    job.samples = 4;
    job.width = job.film_width = film_size;
    const double step = std::exp2(random.uniform(-9.0, 0.5)) / film_size, turn = random.uniform(-0.2, 0.2);
    job.camera.origin = eye;
    job.camera.direction_dx = Vec3d{std::cos(turn), std::sin(turn), 0} * step;
    job.camera.direction_dy = Vec3d{std::sin(turn), -std::cos(turn), 0} * step;
    const Vec3d middle = {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), -1};
    job.camera.direction = middle - (job.camera.direction_dx + job.camera.direction_dy) * (0.5 * film_size);
    return job;
}

struct Case {
    PreparedScene prepared;
    PixelJob job;
    SceneView scene;
    CertainView certain;
    ConstantMemoryTracer tracer;

    explicit Case(std::uint64_t seed) {
        test::Random random(seed);
        const double far = random.below(4) == 0 ? 100 : 1;
        const Vec3d eye = Vec3d{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.5} * far;
        prepared = random_scene(random, eye);
        job = random_job(random, eye);
        scene = view(prepared);
        certain = make_certain_view(make_certain_scene(scene), job.camera, {0, film_size, 0, film_size});
        tracer = make_constant_memory_tracer(scene, scene);
    }
};

TEST(CertainLight, HasTheBitsOfTheGeneralCode) {
    std::size_t valid = 0, none = 0, certain = 0, hits = 0;
    for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
        const Case c(seed);
        valid += c.certain.is_valid;
        if (c.certain.is_valid == 0) continue;
        for (std::uint32_t pixel = 0; pixel < film_size * film_size; pixel += 3) {
            const std::uint32_t x = pixel % film_size, y = pixel / film_size;
            const SampleId<float> id = {&c.job.keys, 0, pixel, 0};
            const Ray<float> ray = sample_ray<NoEffects, float>(c.job, id, x, y);
            const CertainHit hit = certain_hit(c.certain, ray.direction, ConstantMemoryTracer::all_slots);
            const Vec3f careful = careful_radiance<NoEffects>(&c.tracer, &c.scene, &c.job, x, y, 0);
            Vec3f radiance = background(c.scene.environment, ray.direction);
            hits += hit.slot == CertainHit::none ? 0 : 1;
            if (hit.slot == CertainHit::unsure) continue;
            if (hit.slot != CertainHit::none) {
                if (!certain_light(c.certain, ray.direction, hit, radiance)) continue;
                ++certain;
            } else {
                ++none;
            }
            for (int channel = 0; channel < 3; ++channel) {
                ASSERT_EQ(bits_of(radiance[channel]), bits_of(careful[channel]))
                    << "Case(" << seed << "), pixel " << x << ", " << y << ", slot " << hit.slot;
            }
        }
    }
    EXPECT_GT(valid, 900U);
    EXPECT_GT(none, 100'000U);
    EXPECT_GT(certain, 30'000U);
    EXPECT_GT(certain, hits - hits / 5) << "of " << hits;
}

// The nearest hit is not a matter of rounding the light alike: it must be the same primitive.
TEST(CertainHit, IsTheNearestOfTheExactTests) {
    std::size_t found = 0;
    for (std::uint64_t seed = 5000; seed < 6500; ++seed) {
        const Case c(seed);
        if (c.certain.is_valid == 0) continue;
        for (std::uint32_t pixel = 0; pixel < film_size * film_size; pixel += 5) {
            const SampleId<float> id = {&c.job.keys, 0, pixel, 0};
            const Ray<float> ray = sample_ray<NoEffects, float>(c.job, id, pixel % film_size, pixel / film_size);
            const CertainHit hit = certain_hit(c.certain, ray.direction, ConstantMemoryTracer::all_slots);
            if (hit.slot == CertainHit::unsure) continue;
            const Closest<float> nearest = LoopTracer{c.scene}.closest(ray, NoSource{}, true);
            std::uint32_t primitive = no_primitive;
            if (hit.slot < CertainView::max_spheres) {
                primitive = hit.slot;
            } else if (hit.slot != CertainHit::none) {
                primitive = c.certain.sphere_count + hit.slot - CertainView::max_spheres;
                const Box& box = c.prepared.boxes[hit.slot - CertainView::max_spheres];
                ASSERT_EQ(hit.axis, cross_box(box, ray).near_axis) << "Case(" << seed << "), pixel " << pixel;
            }
            ASSERT_EQ(primitive, nearest.primitive) << "Case(" << seed << "), pixel " << pixel;
            found += primitive == no_primitive ? 0 : 1;
        }
    }
    EXPECT_GT(found, 20'000U);
}

TEST(CertainPixel, HasTheSumOfItsSamples) {
    for (std::uint64_t seed = 9000; seed < 9100; ++seed) {
        const Case c(seed);
        if (c.certain.is_valid == 0) continue;
        for (std::uint32_t pixel = 0; pixel < film_size * film_size; pixel += 37) {
            const std::uint32_t x = pixel % film_size, y = pixel / film_size;
            const RayBundle rays = bundle_of_tile(c.job.camera, {x, y, 1, 1}, false);
            std::uint32_t slots = 0;
            for (std::uint32_t slot = 0; slot < ConstantMemoryTracer::slot_count; ++slot) {
                if (may_hit(c.tracer, rays, slot)) slots |= 1U << slot;
            }
            const auto usual = render_pixel<NoEffects, float>(c.tracer, c.scene, c.job, x, y, true);
            const auto quick = render_certain_pixel<NoEffects>(c.tracer, c.certain, c.scene, c.job, x, y, slots);
            ASSERT_EQ(quick.sum, usual.sum) << "Case(" << seed << "), pixel " << x << ", " << y;
            if (slots != 0) continue;
            const auto sky = render_sky<NoEffects, float>(c.scene, c.job, x, y);
            ASSERT_EQ(sky.sum, usual.sum) << "Case(" << seed << "), pixel " << x << ", " << y;
        }
    }
}

// Steps of 2^-24 times whole numbers, and steps without the products that are zeros, give the bits of sample_ray().
TEST(PixelDirections, AreThoseOfTheSamples) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        test::Random random(seed);
        PixelJob job = random_job(random, {0, 0, 0});
        const bool is_level = seed % 3 == 0;
        if (is_level) {
            job.camera.direction_dx.y = job.camera.direction_dx.z = -0.0;
            job.camera.direction_dy.x = job.camera.direction_dy.z = 0;
            if (seed % 6 == 0) job.camera.direction.x = -7 * job.camera.direction_dx.x;  // a pixel's corner is at 0
        } else if (seed % 3 == 1) {
            job.camera.direction_dx.z = std::exp2(random.uniform(-99.0, -20.0));
        }
        for (std::uint32_t pixel = 0; pixel < film_size; ++pixel) {
            const std::uint32_t y = (7 * pixel) % film_size;
            const SampleId<float> id = {&job.keys, 0, job.number_of(pixel, y), pixel};
            const Vec3f expected = sample_ray<NoEffects, float>(job, id, pixel, y).direction;
            bool level_is_chosen = false;
            (void)with_directions<float>(job, pixel, y, [&](const auto& directions) {
                using Directions = std::decay_t<decltype(directions)>;
                level_is_chosen = std::is_same_v<Directions, PixelDirections<float, true>>;
                const Vec3f direction = directions.of(id);
                EXPECT_EQ(direction, expected) << "seed " << seed << ", pixel " << pixel;  // 0 == -0
                EXPECT_EQ(bits_of(height_of(direction) + 1.0F), bits_of(height_of(expected) + 1.0F)) << seed;
                return PixelSum<float>();
            });
            ASSERT_EQ(level_is_chosen, is_level) << seed;
        }
    }
}

TEST(CertainPixel, IsNearTheGeneralCodeInTheTierFast) {
    std::size_t pixels = 0, far = 0;
    for (std::uint64_t seed = 9200; seed < 9300; ++seed) {
        const Case c(seed);
        if (c.certain.is_valid == 0) continue;
        for (std::uint32_t pixel = 0; pixel < film_size * film_size; pixel += 41) {
            const std::uint32_t x = pixel % film_size, y = pixel / film_size;
            const auto exact = render_pixel<NoEffects, double>(c.tracer, c.scene, c.job, x, y, true).sum;
            const Vec3d hit = render_certain_pixel<NoEffects, FastFloat>(c.tracer, c.certain, c.scene, c.job, x, y,
                                                                         ConstantMemoryTracer::all_slots)
                                  .sum;
            // with a highlight of shininess 1024, an error of the cosine of 2^-20 is 2^-10
            for (int channel = 0; channel < 3; ++channel) far += std::abs(hit[channel] - exact[channel]) > 0.02 ? 1 : 0;
            ++pixels;
        }
        const PixelSum<FastFloat> sky = render_sky<NoEffects, FastFloat>(c.scene, c.job, 3, 4);
        Vec3d expected = {0, 0, 0};
        for (std::uint32_t sample = 0; sample < c.job.samples; ++sample) {
            const SampleId<double> id = {&c.job.keys, 0, c.job.number_of(3U, 4U), sample};
            expected =
                expected + background(c.scene.environment, sample_ray<NoEffects, double>(c.job, id, 3, 4).direction);
        }
        for (int channel = 0; channel < 3; ++channel) ASSERT_NEAR(sky.sum[channel], expected[channel], 1e-5) << seed;
    }
    EXPECT_GT(pixels, 1000U);
    EXPECT_LE(far, 9U) << "samples at edges may fall to the other side";
}

TEST(CertainView, IsNotValidWhereABoundWouldNotHold) {
    const auto is_valid = [](const auto& change) {
        PreparedScene prepared;
        prepared.spheres = {{{0, 0, -5}, 1}};
        prepared.boxes = {{{2, 2, -6}, {3, 3, -5}}};
        prepared.material_of = {0, 0};
        prepared.materials.resize(1);
        prepared.optics.resize(1);
        prepared.lights = {light_at({3, 4, 0}, {1, 1, 1})};
        CameraView camera{};
        camera.direction = {-0.5, 0.5, -1};
        camera.direction_dx = {0.1, 0, 0};
        camera.direction_dy = {0, -0.1, 0};
        change(prepared, camera);
        const SceneView scene = view(prepared);
        return make_certain_view(make_certain_scene(scene), camera, {0, 10, 0, 10}).is_valid != 0;
    };
    using Scene = PreparedScene;
    using Camera = CameraView;
    EXPECT_TRUE(is_valid([](Scene&, Camera&) {}));
    EXPECT_FALSE(is_valid([](Scene&, Camera& camera) { camera.has_lens = true; }));
    EXPECT_FALSE(is_valid([](Scene&, Camera& camera) { camera.orthographic = true; }));
    EXPECT_FALSE(is_valid([](Scene&, Camera& camera) { camera.direction = {-0.5, 0.5, -1e-9}; }));
    EXPECT_FALSE(is_valid([](Scene&, Camera& camera) { camera.direction.x = NAN; }));
    EXPECT_FALSE(is_valid([](Scene&, Camera& camera) { camera.direction_dx.y = 1e-32; })) << "2^-24 of it is subnormal";
    EXPECT_FALSE(is_valid([](Scene&, Camera& camera) { camera.origin = {0, 0, -4.5}; })) << "inside the sphere";
    EXPECT_FALSE(is_valid([](Scene&, Camera& camera) { camera.origin = {0, 0, -3.95}; })) << "close to the sphere";
    EXPECT_FALSE(is_valid([](Scene&, Camera& camera) { camera.origin = {2, 0, 0}; })) << "in the plane of a face";
    EXPECT_FALSE(is_valid([](Scene&, Camera& camera) { camera.origin = {1e30, 0, 0}; }));
    EXPECT_FALSE(is_valid([](Scene& scene, Camera&) { scene.spheres[0].radius = 1e-9F; }));
    EXPECT_FALSE(is_valid([](Scene& scene, Camera& camera) {
        camera.origin.x = 0.5;
        scene.spheres[0].centre.x = 0x1p-60F;
    })) << "their difference is not exact";
    EXPECT_FALSE(is_valid([](Scene& scene, Camera&) { scene.lights[0].intensity.y = NAN; }));
    EXPECT_FALSE(is_valid([](Scene& scene, Camera&) { scene.lights[0].intensity.y = -1; }));
    EXPECT_FALSE(is_valid([](Scene& scene, Camera&) { scene.lights[0].position.y = 1e30F; }));
    EXPECT_FALSE(is_valid([](Scene& scene, Camera&) { scene.lights.resize(5, scene.lights[0]); }));
    EXPECT_FALSE(is_valid([](Scene& scene, Camera&) { scene.environment.top.x = HUGE_VALF; }));
    EXPECT_FALSE(is_valid([](Scene& scene, Camera&) { scene.materials[0].shininess = 12.5F; }));
    EXPECT_FALSE(is_valid([](Scene& scene, Camera&) { scene.materials[0].shininess = 0; }));
    EXPECT_FALSE(is_valid([](Scene& scene, Camera&) { scene.materials[0].diffuse.x = -0.0F; }));
}

}  // namespace
}  // namespace tandem
