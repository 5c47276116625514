// Cameras that frame a whole scene: what they see, from where, at any scale.
#include "tandem/scene/framing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/random.h"
#include "support/scenes.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/math/turns.h"
#include "tandem/scene/camera_node.h"
#include "tandem/scene/surface_reach.h"

namespace tandem {
namespace {

using test::Random;

constexpr const char* sides[] = {"auto", "front", "back", "left", "right", "top", "bottom", "three-quarter"};

/// A scene of one node with that shape.
Scene scene_of(const Shape& shape, const Trs& trs = {}) {
    Scene scene;
    scene.materials = {{"plain", {}}};
    scene.nodes.resize(1);
    scene.nodes[0].trs = trs;
    scene.nodes[0].geometry = {{shape, 0}};
    return scene;
}

Scene scene_of(std::vector<Vec3f> corners, std::vector<std::uint32_t> triangles) {
    Scene scene = scene_of(MeshShape{0});
    scene.meshes.push_back({.positions = std::move(corners), .triangles = std::move(triangles)});
    return scene;
}

/// A horizontal square of edge 2 at the origin.
Scene floor_scene() { return scene_of({{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, {0, 2, 1, 0, 3, 2}); }

Trs any_trs(Random& random, bool turns) {
    Trs trs;
    const auto number = [&](double from, double to) { return random.uniform(from, to); };
    trs.translation = {number(-3, 3), number(-3, 3), number(-3, 3)};
    if (turns) trs.rotation = {number(-1, 1), number(-1, 1), number(-1, 1), number(0.1, 1)};
    const double scale = number(0.5, 2);
    trs.scale = turns ? Vec3d{number(-2, 2), number(0.5, 2), number(0.5, 2)} : Vec3d{scale, scale, scale};
    return trs;
}

/// Meshes, spheres, boxes and instances below a root of that scale and place.
Scene any_scene(Random& random, double scale, const Vec3d& place) {
    Scene scene;
    scene.materials = {{"plain", {}}};
    Mesh& mesh = scene.meshes.emplace_back();
    for (std::uint32_t i = 0; i < 3 + 3 * random.below(5); ++i) {
        mesh.positions.push_back(
            {random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)});
        if (i >= 2) mesh.triangles.insert(mesh.triangles.end(), {i - 2, i - 1, i});
    }
    mesh.positions.push_back({1e6F, 1e6F, 1e6F});  // that no face uses
    Node root;
    root.trs.translation = place;
    root.trs.scale = {scale, scale, scale};
    scene.nodes.push_back(root);
    for (std::uint32_t i = 0; i < 1 + random.below(4); ++i) {
        const std::uint32_t kind = random.below(3);
        Node node;
        node.parent = 0;
        node.trs = any_trs(random, kind == 0);
        const Shape shape = kind == 0   ? Shape{MeshShape{0}}
                            : kind == 1 ? Shape{SphereShape{random.uniform(0.1, 2.0)}}
                                        : Shape{BoxShape{{random.uniform(0.1, 2.0), random.uniform(0.1, 2.0), 1}}};
        node.geometry = {{shape, 0}};
        if (random.coin()) node.geometry[0].instances = {any_trs(random, false), any_trs(random, false)};
        scene.nodes.push_back(node);
    }
    return scene;
}

/// What a camera sees: the part of the film that the surfaces cover, 1 being the film's edge.
struct Seen {
    Vec2<double> lower{1e300, 1e300}, upper{-1e300, -1e300};
    double nearest = 1e300;  ///< depth

    [[nodiscard]] double largest() const { return std::max({-lower.x, -lower.y, upper.x, upper.y}); }
};

/// From the prepared scene, point by point.
Seen look(const Scene& scene, const std::string& camera, double aspect) {
    const PreparedScene prepared = prepare(scene, {.camera = camera});
    Seen seen;
    const Matrix3 camera_from_render = transpose(prepared.camera.render_from_camera.linear);
    const auto add = [&](const Vec3d& point) {
        const Vec3d p = camera_from_render * (point - prepared.camera.render_from_camera.translation);
        const Vec2<double> at = {p.x / (-p.z * prepared.camera.half_height * aspect),
                                 p.y / (-p.z * prepared.camera.half_height)};
        seen.nearest = std::min(seen.nearest, -p.z);
        for (int i = 0; i < 2; ++i) {
            seen.lower[i] = std::min(seen.lower[i], at[i]);
            seen.upper[i] = std::max(seen.upper[i], at[i]);
        }
    };
    for (const Triangle& t : prepared.triangles) {
        for (const Vec3f& v : {t.v0, t.v1, t.v2}) add(widen(v));
    }
    for (const Box& box : prepared.boxes) {
        for (int i = 0; i < 8; ++i) {
            add(widen(Vec3f{(i & 1 ? box.lower : box.upper).x, (i & 2 ? box.lower : box.upper).y,
                            (i & 4 ? box.lower : box.upper).z}));
        }
    }
    for (const Sphere& sphere : prepared.spheres) {
        for (int i = 0; i < 4096; ++i) {
            const double height = (i + 0.5) / 2048 - 1, across = std::sqrt(1 - height * height);
            const auto [sine, cosine] = sin_cos_turns<float>(i * 0.6180339887498949);
            add(widen(sphere.centre) + Vec3d{across * cosine, height, across * sine} * double{sphere.radius});
        }
    }
    return seen;
}

Scene framed(Scene scene, const std::string& view, double aspect = 1) {
    scene.nodes.push_back(frame_scene(scene, view, aspect).node);
    return scene;
}

/// Where the camera stands as seen from the origin, unit.
Vec3d heading(const Scene& scene, const std::string& view) {
    return normalize(frame_scene(scene, view, 1).node.matrix->translation);
}

TEST(Framing, FillsTheFilmAndCutsNothingOff) {
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        Random random(seed);
        const double scale = std::exp2(random.uniform(-20.0, 20.0));
        const Vec3d place = Vec3d{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)} *
                            (scale * (random.coin() ? 1e5 : 1));
        const Scene scene = any_scene(random, scale, place);
        const double aspect = std::exp2(random.uniform(-2.0, 2.0));
        const char* view = sides[random.below(std::size(sides))];
        const Seen seen = look(framed(scene, view, aspect), view, aspect);
        const std::string label = "Random(" + std::to_string(seed) + "), view " + view;
        ASSERT_GT(seen.nearest, 0) << label;
        ASSERT_LE(seen.largest(), 0.9 + 1e-4) << label;
        ASSERT_GE(seen.largest(), 0.8) << label;
        ASSERT_NEAR(seen.lower.x + seen.upper.x, 0, 0.04) << label;
        ASSERT_NEAR(seen.lower.y + seen.upper.y, 0, 0.04) << label;
    }
}

TEST(Framing, StandsOnTheSideOfItsName) {
    const Scene ball = scene_of(SphereShape{1});
    const struct {
        const char* view;
        Vec3d from;
    } cases[] = {{"auto", {0, 0, 1}},  {"front", {0, 0, 1}}, {"back", {0, 0, -1}},  {"left", {-1, 0, 0}},
                 {"right", {1, 0, 0}}, {"top", {0, 1, 0}},   {"bottom", {0, -1, 0}}};
    for (const auto& c : cases) {
        EXPECT_GT(dot(heading(ball, c.view), c.from), 0.9) << c.view;
        if (c.from.y == 0) {
            EXPECT_GT(heading(ball, c.view).y, 0.1) << c.view << " looks down a little";
        }
    }
    const Vec3d corner = heading(ball, "three-quarter");
    EXPECT_GT(corner.x, 0.3);
    EXPECT_GT(corner.z, 0.3);
    EXPECT_EQ(view_names(), "auto, front, back, left, right, top, bottom, three-quarter");
    EXPECT_TRUE(is_view("top"));
    EXPECT_FALSE(is_view("Top"));
    EXPECT_FALSE(is_view(""));
}

TEST(Framing, KeepsTheWorldUprightInThePicture) {
    const Scene ball = scene_of(SphereShape{1});
    for (const char* view : {"front", "back", "left", "right", "three-quarter"}) {
        const Matrix3 axes = *camera_axes(*frame_scene(ball, view, 1).node.matrix);
        EXPECT_GT(axes.row[1].y, 0.8) << view;
        EXPECT_NEAR(axes.row[0].y, 0, 1e-12) << view;
    }
    // the front of the scene is below in the picture from the top, and above in that from the bottom
    EXPECT_LT(camera_axes(*frame_scene(ball, "top", 1).node.matrix)->row[1].z, -0.99);
    EXPECT_GT(camera_axes(*frame_scene(ball, "bottom", 1).node.matrix)->row[1].z, 0.99);
}

TEST(Framing, SeesAFloorFromAbove) {
    const Seen seen = look(framed(floor_scene(), "auto"), "auto", 1);
    EXPECT_GT(seen.upper.y - seen.lower.y, 0.9) << "at least half of the picture's height";
    EXPECT_EQ(frame_scene(floor_scene(), "left", 1).description, "from the left, 50 degrees above");
}

TEST(Framing, TurnsToWhatIsDeepAndNarrow) {
    const Scene train = scene_of(BoxShape{{1, 1, 20}});
    EXPECT_EQ(frame_scene(train, "auto", 1).description,
              "from the front, turned 40 degrees to the right, 35 degrees above");
    EXPECT_NEAR(heading(train, "front").x, 0, 1e-12) << "but not if the front is asked for";
    const Scene wall = scene_of({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 1, 2});
    const Seen seen = look(framed(wall, "auto"), "auto", 1);
    EXPECT_GT(seen.upper.x - seen.lower.x, 0.5) << "not edge-on";
}

TEST(Framing, FramesWhatHasNoExtent) {
    const std::vector<Vec3f> point = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    const std::vector<Vec3f> line = {{0, 0, -1}, {0, 0, 0}, {0, 0, 1}};
    for (const auto& corners : {point, line}) {
        const Scene scene = scene_of(corners, {0, 1, 2});
        for (const char* view : sides) {
            const Transform camera = *frame_scene(scene, view, 1).node.matrix;
            const Matrix3 axes = *camera_axes(camera);
            for (const Vec3f& corner : corners) {
                const Vec3d at = axes * (widen(corner) - camera.translation);
                EXPECT_LT(at.z, -0.01) << view << ": before the camera";
                EXPECT_LT(std::max(std::abs(at.x), std::abs(at.y)), -at.z * 0.33) << view << ": within the picture";
            }
        }
    }
}

TEST(Framing, LeavesOutWhatIsHidden) {
    Scene scene = scene_of(SphereShape{1});
    const Vec3d alone = frame_scene(scene, "auto", 1).node.matrix->translation;
    scene.meshes.push_back({.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {0, 1, 2}});
    Node hidden;
    hidden.trs = {.translation = {100, 0, 0}, .scale = {0, 0, 0}};
    hidden.geometry = {{MeshShape{0}, 0}};
    scene.nodes.push_back(hidden);
    EXPECT_EQ(frame_scene(scene, "auto", 1).node.matrix->translation, alone);
    scene.nodes[1].trs.scale = {1, 0, 1};  // a line, but of a flat mesh whose face had an area
    EXPECT_NE(frame_scene(scene, "auto", 1).node.matrix->translation, alone);
}

TEST(Framing, TakesFrameZeroOrTheFirstMomentThatShowsSomething) {
    Scene scene = scene_of(std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
    AnimationChannel moves;
    moves.times = {0, 1};
    moves.values = {5, 0, 0, 9, 0, 0};
    scene.animation = {moves};
    EXPECT_NEAR(frame_scene(scene, "auto", 1).node.matrix->translation.x, 5.5, 0.1);
    AnimationChannel grows;
    grows.path = AnimatedPath::scale;
    grows.times = {0, 1};
    grows.values = {0, 0, 0, 2, 2, 2};
    scene.animation.push_back(grows);
    const Framing framing = frame_scene(scene, "auto", 1);
    EXPECT_FALSE(framing.is_empty);
    EXPECT_NEAR(framing.node.matrix->translation.x, 7.5, 0.3) << "half-way";
}

TEST(Framing, OfNothingOrTooMuchStandsBeforeTheOrigin) {
    const Scene nothing;
    EXPECT_TRUE(frame_scene(nothing, "auto", 1).is_empty);
    Scene huge = scene_of(SphereShape{1});
    huge.nodes[0].trs.translation = {5e17, 0, 0};
    EXPECT_FALSE(frame_scene(huge, "auto", 1).is_empty);
    for (const Scene& scene : {nothing, huge}) {
        const Framing framing = frame_scene(scene, "auto", 1);
        EXPECT_LT(norm1(framing.node.matrix->translation), 10);
        EXPECT_GT(framing.node.matrix->translation.z, 0.5);
    }
}

TEST(Framing, RefusesViewsAndFilmsThatThereAreNot) {
    const Scene ball = scene_of(SphereShape{1});
    EXPECT_TRUE(test::contains(test::input_error([&] { (void)frame_scene(ball, "under", 1); }),
                               "there is no view 'under'; the views are auto, front"));
    for (const double aspect : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
        EXPECT_TRUE(test::contains(test::input_error([&] { (void)frame_scene(ball, "auto", aspect); }), "film"));
    }
}

TEST(SurfaceReach, IsTheSupportOfTheHull) {
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Vec3d d = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
        const double length = std::sqrt(dot(d, d));
        const Trs trs = any_trs(random, true);
        const double moved = dot(d, trs.translation);
        const Scene sphere = scene_of(SphereShape{2}, {.translation = trs.translation, .rotation = trs.rotation});
        EXPECT_NEAR(SurfaceReach(sphere, 0).along({&d, 1})[0], moved + 2 * length, 1e-12);
        const Scene box = scene_of(BoxShape{{1, 2, 3}}, trs);
        double most = -1e300;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3d at = {corner & 1 ? 0.5 : -0.5, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.5 : -1.5};
            most = std::max(most, dot(d, transform_point(to_transform(trs), at)));
        }
        EXPECT_NEAR(SurfaceReach(box, 0).along({&d, 1})[0], most, 1e-12);
    }
    const Scene none;
    EXPECT_TRUE(SurfaceReach(none, 0).is_empty());
}

}  // namespace
}  // namespace tandem
