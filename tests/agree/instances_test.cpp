// Meshes that are kept once: the same bits as with every face written out, and hierarchies that hold them.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "support/backend_list.h"
#include "support/random.h"
#include "support/structure.h"
#include "support/thrown_message.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/build_bvh.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/first_hit.h"
#include "tandem/kernel/shadow.h"
#include "tandem/kernel/spawn_ray.h"
#include "tandem/kernel/traversal/instanced_tracer.h"
#include "tandem/scene/icosphere.h"

namespace tandem {
namespace {

using test::Random;

/// What distinguishes a scene of instances.
struct Crowd {
    const char* name;
    int edge = 3;        ///< edge^3 instances
    double scale = 0.8;  ///< of a mesh of radius 1, whose neighbours are `spacing` away
    bool mirrors = true, turns = true, thin = false, twice = false;
    Vec3d at{0, 0, 0};
    bool ground = false;  ///< and spheres: primitives of other kinds
    bool masked = false;  ///< the ground, in part
    bool leaves = false;  ///< the instances have an alpha mask, by texture and colours
    bool normals = true, colours = false;
    FaceSides sides = FaceSides::single_sided;
    bool closed = false;
    double spacing = 2.2;
};

void PrintTo(const Crowd& crowd, std::ostream* out) { *out << crowd.name; }

Scene scene_of(const Crowd& crowd) {
    Scene scene;
    scene.meshes = {icosphere(2)};
    if (!crowd.normals) scene.meshes[0].normals.clear();
    if (crowd.colours) {
        for (const Vec3f& p : scene.meshes[0].positions) {
            scene.meshes[0].colours.push_back({{absolute(p.x), absolute(p.y), absolute(p.z)}, 1});
        }
    }
    scene.materials = {{"red", {{0.1F, 0, 0}, {0.8F, 0.2F, 0.2F}, {1, 1, 1}, 32}}, {"grey", {}}};
    scene.meshes[0].is_closed = crowd.closed;
    scene.materials[0].sides = crowd.sides;
    if (crowd.leaves) {
        Mesh& mesh = scene.meshes[0];
        std::vector<Vec2f>& texcoords = mesh.texcoords.emplace_back();
        for (const Vec3f& p : mesh.positions) {
            texcoords.push_back({4 * p.x, 4 * p.y});
            mesh.colours.push_back({{1, 1, 1}, p.z > 0.3F ? 0.2F : 1.0F});
        }
        scene.images = {{"chequers", 2, 2, {0xFF40C040U, 0x00FFFFFFU, 0x00FFFFFFU, 0xFF20A0F0U}}};
        scene.textures = {{.image = 0}};
        scene.materials[0].diffuse_texture = TextureReference{.texture = 0};
        scene.materials[0].alpha_mode = AlphaMode::mask;
    }
    scene.nodes.resize(4);
    scene.nodes[0].camera = PerspectiveCamera{1.0};
    scene.nodes[0].trs.translation = crowd.at + Vec3d{2, 3, 12};
    scene.nodes[1].light = LightSource{};
    scene.nodes[1].trs.translation = crowd.at + Vec3d{-3, 9, 7};
    scene.nodes[2].geometry = {{MeshShape{0}, 0, {}}};
    Random random(17);
    const auto u = [&] { return random.uniform(-1.0, 1.0); };
    for (int i = 0; i < crowd.edge * crowd.edge * crowd.edge; ++i) {
        const Vec3d place = {i % crowd.edge + 0.2 * u(), i / crowd.edge % crowd.edge + 0.2 * u(),
                             i / crowd.edge / crowd.edge + 0.2 * u()};
        Trs trs;
        trs.translation = crowd.at + place * crowd.spacing;
        if (crowd.turns) trs.rotation = {u(), u(), u(), u() + 1.5};
        trs.scale = Vec3d{1 + 0.5 * u(), 1 + 0.5 * u(), 1 + 0.5 * u()} * crowd.scale;
        if (crowd.mirrors && random.coin()) trs.scale.x = -trs.scale.x;
        if (crowd.thin && random.coin()) trs.scale.y *= 0.02;
        scene.nodes[2].geometry[0].instances.push_back(trs);
        if (crowd.twice) scene.nodes[2].geometry[0].instances.push_back(trs);
    }
    if (crowd.ground) {
        Mesh ground;
        ground.positions = {{-20, -2, -20}, {20, -2, -20}, {20, -2, 20}, {-20, -2, 20}};
        ground.triangles = {0, 2, 1, 0, 3, 2};
        if (crowd.masked) {
            for (std::size_t i = 0; i < 4; ++i) ground.colours.push_back({{1, 1, 1}, i < 2 ? 1.0F : 0.1F});
            scene.materials[1].alpha_mode = AlphaMode::mask;
        }
        scene.meshes.push_back(ground);
        scene.nodes[3].geometry = {{MeshShape{1}, 1, {}}, {SphereShape{1.5}, 1, {}}, {BoxShape{{1, 5, 1}}, 0, {}}};
    }
    return scene;
}

const Crowd crowds[] = {
    {.name = "turned"},
    {.name = "plain", .mirrors = false, .turns = false},
    {.name = "thin", .thin = true},
    {.name = "overlapping", .scale = 2.5},
    {.name = "twice", .twice = true},
    {.name = "far", .at = {3e5, -2e5, 7e5}},
    {.name = "with others", .ground = true},
    {.name = "without normals", .ground = true, .normals = false},
    {.name = "culled", .ground = true, .sides = FaceSides::culled},
    {.name = "closed and culled", .sides = FaceSides::culled, .closed = true},
    {.name = "double sided", .sides = FaceSides::double_sided},
    {.name = "coloured", .ground = true, .colours = true},
    {.name = "masked", .ground = true, .masked = true},
    {.name = "leaves", .leaves = true},
    {.name = "leaves among others", .scale = 2.0, .ground = true, .masked = true, .leaves = true},
    {.name = "leaves twice", .twice = true, .leaves = true},
    {.name = "closed and culled leaves", .leaves = true, .sides = FaceSides::culled, .closed = true},
};

PreparedScene kept_once(const Crowd& crowd) {
    PrepareOptions options;
    options.instanced_from = 1;
    return prepare(scene_of(crowd), options);
}

class Instances : public ::testing::TestWithParam<Crowd> {};
INSTANTIATE_TEST_SUITE_P(All, Instances, ::testing::ValuesIn(crowds), [](const auto& info) {
    std::string name = info.param.name;
    for (char& c : name) c = c == ' ' ? '_' : c;
    return name;
});

/// The corners of faces as sets of bits.
std::multiset<std::array<std::uint32_t, 9>> corners(const PreparedScene& scene) {
    std::multiset<std::array<std::uint32_t, 9>> all;
    for (const Triangle& t : scene.triangles) {
        std::array<std::uint32_t, 9> bits{};
        int k = 0;
        for (const Vec3f& v : {t.v0, t.v1, t.v2}) {
            for (int i = 0; i < 3; ++i) bits[static_cast<std::size_t>(k++)] = bits_of(v[i] + 0.0F);
        }
        all.insert(bits);
    }
    return all;
}

TEST_P(Instances, AreTheFacesThatPrepareWritesOut) {
    const PreparedScene kept = kept_once(GetParam());
    ASSERT_FALSE(kept.instances.empty());
    EXPECT_GE(kept.instances.instances.size(), 8U);
    const PreparedScene written = written_out(kept, "this is a test");
    PrepareOptions never;
    never.origin = kept.origin;
    const PreparedScene direct = prepare(scene_of(GetParam()), never);
    ASSERT_TRUE(direct.instances.empty());
    EXPECT_EQ(written.triangles.size(), direct.triangles.size());
    EXPECT_EQ(written.normals.size(), direct.normals.size());
    EXPECT_EQ(primitive_count(written), primitive_count(direct));
    EXPECT_TRUE(corners(written) == corners(direct));
    EXPECT_EQ(prepare(scene_of(GetParam())).origin, kept.origin);
}

TEST_P(Instances, AreHeldByTheirHierarchies) {
    PreparedScene scene = kept_once(GetParam());
    const InstancedBvh bvh = build_instanced_bvh(scene);
    EXPECT_EQ(find_instanced_bvh_defect(bvh, scene), "");
}

/// The tracer on the host.
struct Traced {
    explicit Traced(const Crowd& crowd) : scene(kept_once(crowd)), bvh(build_instanced_bvh(scene)) {
        const SceneView others = view(scene);
        if (primitive_count(others) > 0) {
            Aabb bounds;
            for (std::uint32_t id = 0; id < primitive_count(others); ++id) {
                bounds = merge(bounds, primitive_bounds(others, id));
            }
            frame = make_structure_frame(bounds, BoxErrors::of_distance);
            other_bvh = build_bvh(others, frame.padding);
        }
    }
    [[nodiscard]] InstancedTracer tracer() const {
        const SceneView others = view(scene);
        const BvhView of_others = {other_bvh.nodes.empty() ? nullptr : other_bvh.nodes.data(),
                                   other_bvh.entry_spheres.data(),
                                   other_bvh.entry_ids.data(),
                                   other_bvh.entry_triangles.data(),
                                   other_bvh.placements.data(),
                                   frame,
                                   nullptr};
        return {{instanced_view(scene),
                 {{others, of_others}},
                 {bvh.nodes.data(), bvh.entry_instances.data(), bvh.entry_faces.data(),
                  static_cast<std::uint32_t>(bvh.entry_instances.size()), bvh.frame}}};
    }
    PreparedScene scene;
    InstancedBvh bvh;
    StructureFrame frame{};
    Bvh other_bvh;
};

std::vector<Ray<float>> rays_through(const Aabb& box, int count) {
    Random random(23);
    std::vector<Ray<float>> rays;
    const Vec3f middle = centre(box), extent = box.upper - box.lower;
    const auto u = [&] { return random.uniform(-0.5F, 0.5F); };
    for (int i = 0; i < count; ++i) {
        const Vec3f within = middle + Vec3f{u() * extent.x, u() * extent.y, u() * extent.z};
        const Vec3f towards = middle + Vec3f{u() * extent.x, u() * extent.y, u() * extent.z};
        const float away = i % 3 == 0 ? 0.0F : i % 3 == 1 ? 1.5F : 300.0F;
        const Vec3f origin = within + Vec3f{u() * extent.x, u() * extent.y, u() * extent.z} * away;
        Vec3f direction = towards - origin;
        if (i % 7 == 0) direction.x = 0;
        if (i % 11 == 0) direction = {0, 0, -1};
        rays.push_back({origin, direction * std::abs(random.log_uniform(-3, 3))});
    }
    return rays;
}

/// Lines through the origin of space, from so far away that one step in double does not reach it.
std::vector<Ray<float>> rays_from_very_far(int count) {
    Random random(37);
    std::vector<Ray<float>> rays;
    for (int i = 0; i < count; ++i) {
        const auto u = [&] { return random.uniform(-1.0F, 1.0F); };
        const Vec3f direction = {u(), u(), u()};
        rays.push_back({direction * -std::exp2(static_cast<float>(20 + i % 40)), direction});
    }
    return rays;
}

std::vector<Ray<float>> rays_in_space(const Aabb& box, int count) {
    std::vector<Ray<float>> rays = rays_through(box, count);
    const std::vector<Ray<float>> from_very_far = rays_from_very_far(count / 8);
    rays.insert(rays.end(), from_very_far.begin(), from_very_far.end());
    return rays;
}

/// As an intersection with every face written out, for rays in space, from surfaces, past masks and to lights.
template <class Real>
void expect_same(const InstancedTracer& tracer, const BvhTracer& reference, const Ray<Real>& ray,
                 const std::string& what, bool has_copies) {
    const auto same = [&](const auto& r, const auto& source, const std::string& how) {
        const Closest<Real> a = tracer.closest(r, source, true), b = reference.closest(r, source, true);
        ASSERT_EQ(a.primitive, b.primitive) << what << how;
        ASSERT_EQ(bits_of(a.t), bits_of(b.t)) << what << how;
    };
    same(ray, NoSource{}, "");
    const Closest<Real> hit = reference.closest(ray, NoSource{}, true);
    if (::testing::Test::HasFatalFailure() || hit.primitive == no_primitive) return;
    PathSource<Real> path;
    path.last_masked = hit;
    // past a mask, a copy would be hit at the same t; backends do not trace copies
    if (!has_copies) same(ray, path, ", past the first hit");
    const SurfacePoint<Real> a = surface_point<InstancedTracer::kinds>(tracer.scene, ray, NoSource{}, hit, true);
    const SurfacePoint<Real> b = surface_point(reference.scene, ray, NoSource{}, hit, true);
    ASSERT_EQ(bits_of(a.position.x), bits_of(b.position.x)) << what;
    ASSERT_EQ(bits_of(a.normal.y), bits_of(b.normal.y)) << what;
    const SpawnedRay<Real> spawned = spawn_ray(b, Vec3<Real>{ray.direction.y, -ray.direction.x, ray.direction.z});
    if (!is_traceable(spawned.ray)) return;
    same(spawned.ray, spawned.source, ", onwards");
    same(spawned.ray, PathSource<Real>{spawned.source}, ", onwards as a path");
    ShadowSource<Real> shadow;
    static_cast<Source<Real>&>(shadow) = spawned.source;
    for (const double t : {1e-3, 1.0, 30.0, 1e300}) {
        ASSERT_EQ(tracer.occluded(spawned.ray, t, shadow, true), reference.occluded(spawned.ray, t, shadow, true))
            << what << ", until " << t;
        using Effects = EffectSet<(Effect::shadows | Effect::cutouts).bits()>;
        const ShadowRay<Real> through_masks = {spawned.ray, shadow, t, true};
        UInt<Real> rays = 0;
        const auto is_blocked = [&](const auto& by) {
            return is_blocked_by_opaque<Effects>(by, by.scene, through_masks, rays);
        };
        ASSERT_EQ(is_blocked(tracer), is_blocked(LoopTracer{reference.scene})) << what << ", until " << t;
    }
}

TEST_P(Instances, AreHitAsIfTheyWereWrittenOut) {
    const Traced traced(GetParam());
    const test::Structure written(written_out(traced.scene, "this is a test"));
    const BvhTracer reference = written.tracer();
    const InstancedTracer tracer = traced.tracer();
    const std::vector<Ray<float>> rays = rays_in_space(written.bounds, 1500);
    const bool has_copies = GetParam().twice && !GetParam().leaves;  // those with alpha masks are traced
    std::size_t hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!is_traceable(rays[i])) continue;
        const std::string what = std::string(GetParam().name) + ", ray " + std::to_string(i);
        expect_same<float>(tracer, reference, rays[i], what, has_copies);
        if (i % 5 == 0)
            expect_same<double>(tracer, reference, to_real<double>(rays[i]), what + ", precise", has_copies);
        if (HasFatalFailure()) return;
        hits += reference.closest(rays[i], NoSource{}, true).primitive >= tracer.scene.first_instanced_id ? 1 : 0;
    }
    EXPECT_GT(hits, rays.size() / 10);
}

using Exact = long double;
struct ExactPoint {
    Exact x, y, z;
};
Exact along(const Vec3d& row, const ExactPoint& p) { return row.x * p.x + row.y * p.y + row.z * p.z; }

/// A ray in the frame of a mesh, at the point that it has at `t` in render space.
struct MovedPoint {
    MovedPoint(const InstancedTracer& tracer, const EntryInstance& entry, const Ray<float>& ray, Exact t) {
        const Proposal<float> proposal = propose_quickly(ray, tracer.bvh.frame);
        EXPECT_TRUE(proposal.active);
        const QueryRay query = make_query_ray(proposal, tracer.bvh.frame, NoSource{});
        const auto exact_query = instanced_detail::exact_query(ray, tracer.bvh.frame, proposal);
        const instanced_detail::MovedRay moved = instanced_detail::move_to_object(entry, query, exact_query);
        const Vec3d o = widen(ray.origin), d = widen(ray.direction), c = widen(entry.centre);
        local =
            (t - proposal.t_offset) * std::sqrt(Exact{d.x} * d.x + Exact{d.y} * d.y + Exact{d.z} * d.z) - moved.from;
        const Transform& place = tracer.scene.instances[entry.number].render_from_object;
        const ExactPoint from_centre = {o.x - c.x + t * d.x, o.y - c.y + t * d.y, o.z - c.z + t * d.z};
        Exact most = 0, norm = 0;
        const Matrix3 inverse_of = inverse(place.linear);
        for (int i = 0; i < 3; ++i) {
            const Exact is = moved.origin[i] + local * moved.direction[i];
            most = std::max(most, std::abs(is - along(inverse_of.row[i], from_centre)));
            norm = std::max(norm, Exact{norm1(inverse_of.row[i])});
        }
        error = most / norm * 0x1p24L;
    }
    Exact local;  ///< its parameter there
    Exact error;  ///< of a coordinate, relative to the instance's centre, in row_norm * 2^-24
};

/// Scattered over a thousand times their size, rays are as accurate near each instance as the bound in
/// docs/instances.md says, and hit the same.
TEST(ScatteredInstances, AreHitByRaysMovedWithinTheBound) {
    const Crowd crowd = {.name = "scattered", .spacing = 900};
    const Traced traced(crowd);
    const test::Structure written(written_out(traced.scene, "this is a test"));
    const InstancedTracer tracer = traced.tracer();
    const BvhTracer reference = written.tracer();
    const PreparedInstances& all = traced.scene.instances;
    const double reach_of_scene = reach(traced.bvh.frame.bounds);
    Random random(29);
    std::size_t hits = 0;
    for (int i = 0; i < 4000; ++i) {
        const EntryInstance& entry =
            traced.bvh.entry_instances[random.below(static_cast<std::uint32_t>(all.instances.size()))];
        std::size_t m = 0;
        while (entry.number >= all.meshes[m].first_instance + all.meshes[m].instance_count) ++m;
        const std::uint32_t f = random.below(all.meshes[m].face_count);
        const Triangle face = placed({all.instances[entry.number], all.faces[all.meshes[m].first_face + f], 0});
        // at every third corner, where more faces may be hit than a walk keeps
        const double inside = i % 3 == 0 ? 0.0 : 0.5;
        const double u = random.uniform(0.0, inside), v = random.uniform(0.0, inside);
        const Vec3d target = widen(face.v0) * (1 - u - v) + widen(face.v1) * u + widen(face.v2) * v;
        Vec3d towards = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
        towards = normalize(towards);
        const double distance = std::abs(random.log_uniform(-1, 13));
        const Vec3f origin = narrow(target - towards * distance);
        const double length = std::abs(random.log_uniform(-3, 3));
        const Ray<float> ray = {origin, narrow((target - widen(origin)) * (length / distance))};
        const std::string what = "ray " + std::to_string(i);
        expect_same<float>(tracer, reference, ray, what, false);
        if (i % 5 == 0) expect_same<double>(tracer, reference, to_real<double>(ray), what + ", precise", false);
        if (HasFatalFailure()) return;
        hits += reference.closest(ray, NoSource{}, true).primitive != no_primitive ? 1 : 0;
        const MovedPoint moved(tracer, entry, ray, distance / length);
        const double moved_from_afar = distance > reach_of_scene ? 2 * reach_of_scene : 0;
        EXPECT_LE(moved.error, moved_from_afar + 34 * double{entry.radius}) << what;
        EXPECT_GE(moved.local, 0) << what;
        EXPECT_LE(moved.local, 2 * Exact{entry.radius}) << what;
    }
    EXPECT_GT(hits, 3000U);
}

/// Films and planes of every backend, as of the scene with all faces written out.
class InstancedPictures : public test::ExactBackend {};
INSTANTIATE_TEST_SUITE_P(Backends, InstancedPictures, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

TEST_P(InstancedPictures, AreThoseOfTheSceneWrittenOut) {
    for (const Crowd& crowd : crowds) {
        for (const bool bounces : {false, true}) {
            Scene scene = scene_of(crowd);
            scene.indirect_light = bounces;
            if (bounces) scene.materials[0].optics.mirror = {0.3F, 0.3F, 0.3F};
            PrepareOptions options;
            options.instanced_from = 1;
            const PreparedScene kept = prepare(scene, options);
            EXPECT_EQ(kept.effects, prepare(scene).effects) << crowd.name;
            RenderJob job;
            job.width = 64;
            job.height = 48;
            job.samples = 3;
            job.tier = GetParam().tier;
            job.planes = first_hit_planes;
            const RenderResult a = backend_->render(load(kept), job);
            const RenderResult b = backend_->render(load(written_out(kept, "this is a test")), job);
            EXPECT_EQ(film_hash(a.film), film_hash(b.film)) << crowd.name << (bounces ? ", bounces" : "");
            for (const FilmPlane plane : {FilmPlane::normal, FilmPlane::material, FilmPlane::primitive}) {
                EXPECT_EQ(plane_hash(a.film, plane), plane_hash(b.film, plane)) << crowd.name;
            }
            EXPECT_EQ(a.stats.counters.stack_overflows, 0U) << crowd.name;
        }
    }
}

TEST_P(InstancedPictures, AreOfRaysThatHitTheSame) {
    for (const Crowd& crowd : crowds) {
        const PreparedScene kept = kept_once(crowd);
        const auto instanced = load(kept), written = load(written_out(kept, "this is a test"));
        Traced traced(crowd);
        const std::vector<Ray<float>> rays = rays_in_space(traced.bvh.frame.bounds, 20'000);
        std::vector<Hit> a(rays.size()), b(rays.size());
        (void)backend_->trace(*instanced, rays, a);
        (void)backend_->trace(*written, rays, b);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            differ += a[i].primitive != b[i].primitive || bits_of(a[i].t) != bits_of(b[i].t) ? 1 : 0;
        }
        EXPECT_EQ(differ, 0U) << crowd.name;
    }
}

}  // namespace
}  // namespace tandem
