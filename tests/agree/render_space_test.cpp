// Where a scene lies in the world must not show: preparation moves it to where floats are dense
// (compile/render_origin.h).

#include <gtest/gtest.h>

#include <cmath>

#include "support/backend_list.h"
#include "support/under_parent.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/compare.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::under_parent;

RenderJob shifted_job() {
    RenderJob job;
    job.width = 160;
    job.height = 120;
    job.samples = 4;
    return job;
}

Film render(const PreparedScene& scene) {
    const auto cpu = make_backend("cpu");
    return cpu->render(cpu->load(scene), shifted_job()).film;
}

// J1. The grid of these scenes has a step of 16 or 32: a translation by a multiple of it changes nothing but the
// origin, if the translated coordinates are doubles. Others move every coordinate by less than a step, so that it
// rounds anew.
TEST(RenderSpace, DoesNotShowWhereTheSceneLies) {
    for (const char* name : {"paper", "spheres/500", "mixed/64"}) {
        const Scene scene = named_scene(name);
        const PreparedScene here = prepare(scene);
        const Film expected = render(here);
        for (const double distance : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
            const PreparedScene there = prepare(under_parent(scene, {distance, -distance, 0.7 * distance}, 1));
            const FilmDifference difference = compare(render(there), expected);
            // 16 u: what rounding may move a point by, seen from the camera. A sample at a silhouette may fall to the
            // other side of it.
            EXPECT_LE(difference.mean, 2e-6) << name << " at " << distance;
            EXPECT_LE(difference.residual_rate(Tolerance::one_level), 1e-3) << name << " at " << distance;
            const Vec3d moved = there.origin - here.origin;
            EXPECT_NEAR(moved.x / distance, 1, 0.4) << name << " at " << distance;
        }
        const Film far = render(prepare(under_parent(scene, {0x1p22, -0x1p23, 0x1p20}, 1), {}));
        const FilmDifference exactly = compare(far, expected);
        EXPECT_LE(exactly.largest, 2e-6) << name;
    }
}

// What the rule is there for: without it the same scene is not recognisable.
TEST(RenderSpace, IsWhatMakesItSo) {
    const Scene scene = named_scene("paper");
    const Scene far = under_parent(scene, {1e7, -1e7, 7e6}, 1);
    const FilmDifference world = compare(render(prepare(far, {.origin = Vec3d{0, 0, 0}})), render(prepare(scene)));
    EXPECT_GT(world.residual_rate(Tolerance::one_level), 0.05);
}

// J2: a small body in a scene far away, as one that is built there.
TEST(RenderSpace, KeepsSmallBodiesFarAway) {
    const Scene scene = named_scene("mixed/64");
    const Film expected = render(prepare(scene));
    const Film small = render(prepare(under_parent(scene, {1e6, 2e6, -3e6}, 1e-3)));
    EXPECT_LE(compare(small, expected).mean, 1e-4);
    EXPECT_LE(compare(small, expected).residual_rate(Tolerance::one_level), 1e-2);
}

// J10
TEST(RenderSpace, ScalesByPowersOfTwoToTheBit) {
    for (const char* name : {"paper", "mixed/64", "spheres/500", "boxes/30"}) {
        const Scene scene = named_scene(name);
        const std::string expected = film_hash(render(prepare(scene)));
        for (const int exponent : {-40, -20, -7, -1, 1, 10, 40}) {
            const Film scaled = render(prepare(under_parent(scene, {0, 0, 0}, std::ldexp(1.0, exponent))));
            EXPECT_EQ(film_hash(scaled), expected) << name << " times 2^" << exponent;
        }
    }
}

TEST(RenderSpace, TakesTheRaysOfCallers) {
    const Scene far = under_parent(named_scene("paper"), {1e7, 0, 0}, 1);
    const PreparedScene scene = prepare(far);
    const Vec3d eye_in_world = {1e7, 0, 0};
    const Vec3d eye = render_from_world(scene, eye_in_world);
    EXPECT_EQ(world_from_render(scene, eye), eye_in_world);
    const auto cpu = make_backend("cpu");
    const std::vector<Ray<float>> rays = {{narrow(eye), {0, 0, -1}}};
    std::vector<Hit> hits(1);
    cpu->trace(*cpu->load(scene), rays, hits);
    EXPECT_NE(hits[0].primitive, no_primitive);
    EXPECT_NEAR(hits[0].t, 2.5, 1e-5) << "the green sphere";
}

}  // namespace
}  // namespace tandem
