// A packet whose lanes hit different triangles gives the bits of each ray alone.
#include "tandem/kernel/hit_primitives.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <set>
#include <vector>

#include "support/random.h"
#include "tandem/kernel/surface.h"
#include "tandem/math/lanes.h"

namespace tandem {
namespace {

using Packet = Lanes<float, Sse4>;
using Pictures = EffectSet<(Effect::textures | Effect::normal_maps | Effect::cutouts | Effect::emission |
                            Effect::shadows | Effect::microfacets)
                               .bits()>;
using Plain = EffectSet<0>;

/// Triangles of three materials with a texture, with and without normals and texture coordinates, seen from both
/// sides; some are so thin that their normal needs exact arithmetic. Spheres and quads are there too.
class Surfaces {
  public:
    explicit Surfaces(test::Random& random) {
        const auto point = [&] {
            return Vec3f{random.uniform(-2.0F, 2.0F), random.uniform(-2.0F, 2.0F), random.uniform(-2.0F, 2.0F)};
        };
        // most faces of a scene are alike
        const auto most = random.bits();
        const auto attributes = [&] {
            const auto bits = random.below(4) == 0 ? random.bits() : most;
            FaceAttributes of_face;
            of_face.sides = static_cast<FaceSides>(bits % 3);
            if ((bits >> 8 & 1U) != 0) of_face.normals = random.below(90);
            if ((bits >> 9 & 1U) != 0) of_face.texcoords = random.below(90);
            return of_face;
        };
        for (int i = 0; i < 100; ++i) {
            normals_.push_back(random.below(9) == 0 ? Vec3f{0, 0, 0} : narrow(normalize(widen(point()))));
            texcoords_.push_back({random.uniform(-1.0F, 2.0F), random.uniform(-1.0F, 2.0F)});
        }
        for (int i = 0; i < 3; ++i) {
            spheres_.push_back({point(), random.uniform(0.1F, 1.5F)});
            quads_.push_back({point(), point(), point(), point(), attributes()});
        }
        for (int i = 0; i < 24; ++i) {
            const Vec3f v0 = point(), v1 = point();
            const Vec3f on_edge = v0 * 0.25F + v1 * 0.75F;
            const Vec3f beside = on_edge + Vec3f{1, 1, 1} * random.uniform(1e-7F, 1e-6F);
            triangles_.push_back({v0, v1, i % 8 == 7 ? beside : point(), attributes()});
        }
        for (std::uint32_t i = 0; i < 64; ++i) texels_.push_back(static_cast<std::uint32_t>(random.bits()));
        for (int i = 0; i < 512; ++i) levels_.push_back(static_cast<float>(i % 256) / 255.0F);
        textures_.push_back({0, 8, 8, Wrap::repeat, Wrap::mirrored_repeat, Filter::linear, ColourSpace::srgb});
        for (int i = 0; i < 3; ++i) {
            Optics optics;
            optics.emission = i == 1 ? Vec3f{1, 2, 3} : Vec3f{0, 0, 0};
            optics_.push_back(optics);
            materials_.push_back({point(), point(), point(), 8});
            MaterialTextures textures;
            textures.diffuse.texture = i == 2 ? no_texture : 0;
            textures.normal.texture = i == 1 ? 0 : no_texture;
            textures.alpha_cutoff = i == 0 ? 0.5F : 0.0F;
            textured_.push_back(textures);
        }
        for (std::size_t i = 0; i < spheres_.size() + triangles_.size() + quads_.size(); ++i) {
            material_of_.push_back(random.below(4) == 0 ? random.below(3) : static_cast<std::uint32_t>(most >> 16) % 3);
        }
        view_.spheres = spheres_.data();
        view_.triangles = triangles_.data();
        view_.quads = quads_.data();
        view_.sphere_count = static_cast<std::uint32_t>(spheres_.size());
        view_.triangle_count = static_cast<std::uint32_t>(triangles_.size());
        view_.quad_count = static_cast<std::uint32_t>(quads_.size());
        view_.normals = normals_.data();
        view_.texcoords = texcoords_.data();
        view_.material_of = material_of_.data();
        view_.materials = materials_.data();
        view_.optics = optics_.data();
        view_.textures = {texels_.data(), textures_.data(), textured_.data(), levels_.data()};
    }
    [[nodiscard]] const SceneView& view() const { return view_; }
    [[nodiscard]] std::vector<Triangle>& triangles() { return triangles_; }
    void set_normals(const Vec3f* normals) { view_.normals = normals; }

    /// A ray that hits primitive `id`, and the hit.
    struct Shot {
        Ray<float> ray;
        Closest<float> hit;
    };
    [[nodiscard]] Shot shot_at(std::uint32_t id, test::Random& random) const {
        Shot shot = {{{0, 0, 0}, {0, 0, 1}}, no_hit<float>()};
        visit_primitive<PrimitiveKinds::all>(view_, id, [&](const auto& body) {
            for (int trial = 0; trial < 2000 && shot.hit.primitive != id; ++trial) {
                const auto coordinate = [&] { return random.uniform(-3.0F, 3.0F); };
                shot.ray.origin = {coordinate(), coordinate(), coordinate()};
                shot.ray.direction = aim(body, random) - shot.ray.origin;
                double t = 0;
                if (is_traceable(shot.ray) && first_hit(body, shot.ray, t, true)) shot.hit = {t, id};
            }
        });
        return shot;
    }

  private:
    template <class Body>
    static Vec3f aim(const Body& body, test::Random& random) {
        if constexpr (is_face<Body>) {
            const float u = random.uniform(0.0F, 1.0F), v = random.uniform(0.0F, 1.0F - u);
            return body.v0 + (body.v1 - body.v0) * u + (body.v2 - body.v0) * v;
        } else {
            return Vec3f(bounds(body).lower + bounds(body).upper) * 0.5F;
        }
    }

    std::vector<Sphere> spheres_;
    std::vector<Triangle> triangles_;
    std::vector<Quad> quads_;
    std::vector<Vec3f> normals_;
    std::vector<Vec2f> texcoords_;
    std::vector<std::uint32_t> material_of_, texels_;
    std::vector<PhongMaterial> materials_;
    std::vector<Optics> optics_;
    std::vector<float> levels_;
    std::vector<TextureDescriptor> textures_;
    std::vector<MaterialTextures> textured_;
    SceneView view_{};
};

/// What a vertex has in lane i for these effects.
template <class Effects, class Real>
std::vector<double> numbers_of(const Vertex<Real>& vertex, int i) {
    std::vector<double> numbers;
    const auto add = [&](const auto& a) { numbers.push_back(static_cast<double>(lane(a, i))); };
    const auto add_all = [&](const auto& a) {
        add(a.x);
        add(a.y);
        add(a.z);
    };
    add_all(vertex.surface.normal);
    add_all(vertex.surface.reflectance.ambient);
    add_all(vertex.surface.reflectance.lobes.diffuse.reflectance);
    if (!Effects::has(Effect::shadows)) return numbers;
    add_all(vertex.point.position);
    add_all(vertex.point.normal);
    add_all(vertex.surface.emission);
    add(vertex.point.primitive);
    add(vertex.point.clearance);
    add(vertex.point.from_inside);
    add(vertex.surface.opaque);
    return numbers;
}

/// Lanes that hit primitives `id`, and lanes that hit nothing, against rays alone.
template <class Effects>
void compare(const Surfaces& surfaces, const std::uint32_t (&id)[Packet::size], std::uint64_t seed) {
    test::Random random(seed);
    Ray<Packet> rays;
    Closest<Packet> hits;
    Surfaces::Shot shots[Packet::size];
    for (int i = 0; i < Packet::size; ++i) {
        shots[i] = surfaces.shot_at(id[i], random);
        for (int axis = 0; axis < 3; ++axis) {
            rays.origin[axis].set(i, shots[i].ray.origin[axis]);
            rays.direction[axis].set(i, shots[i].ray.direction[axis]);
        }
        hits.t.set(i, shots[i].hit.t);
        hits.primitive.set(i, shots[i].hit.primitive);
    }
    Vertex<Packet> vertices;
    find_vertex<Effects>(surfaces.view(), rays, NoSource{}, hits, hits.primitive != UInt<Packet>(no_primitive),
                         vertices);
    for (int i = 0; i < Packet::size; ++i) {
        if (shots[i].hit.primitive == no_primitive) continue;
        Vertex<float> vertex;
        find_vertex<Effects>(surfaces.view(), shots[i].ray, NoSource{}, shots[i].hit, true, vertex);
        EXPECT_EQ(numbers_of<Effects>(vertices, i), numbers_of<Effects>(vertex, 0))
            << "seed " << seed << ", lane " << i << ", primitive " << shots[i].hit.primitive;
    }
}

/// The parts of four lanes: how many lanes each has, and whether it is of several triangles.
std::multiset<std::pair<int, bool>> parts_of(const SceneView& scene, const std::uint32_t (&id)[Packet::size]) {
    const auto primitive = UInt<Packet>::from([&](int i) { return id[i]; });
    std::multiset<std::pair<int, bool>> parts;
    const auto note = [&](const auto& part, const Mask<Packet>& here) {
        int lanes = 0;
        for (int i = 0; i < 4; ++i) lanes += here[i] ? 1 : 0;
        parts.insert({lanes, std::is_same_v<std::decay_t<decltype(part)>, ManyTriangles<Packet>>});
    };
    const auto note_triangles = [&](const Mask<Packet>& lanes) {
        return for_each_triangle_part<Packet>(scene, primitive, lanes, note);
    };
    for_each_part<PrimitiveKinds::all, Packet>(scene, primitive, primitive != UInt<Packet>(no_primitive),
                                               note_triangles, note);
    return parts;
}

TEST(HitPrimitives, OfAPacketHaveTheBitsOfEachRay) {
    int together = 0;
    for (std::uint64_t seed = 0; seed < 4000; ++seed) {
        test::Random random(seed);
        const Surfaces surfaces(random);
        std::uint32_t id[Packet::size];
        for (std::uint32_t& of_lane : id) of_lane = random.below(primitive_count(surfaces.view()));
        if (random.below(4) == 0) id[1] = id[0];
        compare<Pictures>(surfaces, id, seed);
        compare<Plain>(surfaces, id, seed);
        if (HasFailure()) return;
        for (const auto& [lanes, of_triangles] : parts_of(surfaces.view(), id)) together += of_triangles ? 1 : 0;
    }
    EXPECT_GT(together, 1000) << "packets in which triangles were one part";
}

TEST(HitPrimitives, ThreeTrianglesOfAMaterialAreOnePart) {
    test::Random random(1);
    Surfaces surfaces(random);
    for (Triangle& triangle : surfaces.triangles()) triangle.attributes = {};
    std::vector<std::uint32_t> materials(primitive_count(surfaces.view()), 0);
    SceneView scene = surfaces.view();
    scene.material_of = materials.data();
    using Parts = std::multiset<std::pair<int, bool>>;
    const std::uint32_t none = no_primitive, sphere = 0, quad = primitive_count(scene) - 1;
    EXPECT_EQ(parts_of(scene, {3, 4, 5, 6}), (Parts{{4, true}}));
    EXPECT_EQ(parts_of(scene, {3, 4, none, 6}), (Parts{{3, true}}));
    EXPECT_EQ(parts_of(scene, {3, sphere, 5, 6}), (Parts{{3, true}, {1, false}}));
    EXPECT_EQ(parts_of(scene, {3, 4, 3, 4}), (Parts{{2, false}, {2, false}})) << "two are not worth it";
    EXPECT_EQ(parts_of(scene, {3, 4, sphere, quad}), (Parts{{1, false}, {1, false}, {1, false}, {1, false}}));
    EXPECT_EQ(parts_of(scene, {none, none, none, none}), Parts{});
    materials[5] = materials[6] = 2;
    EXPECT_EQ(parts_of(scene, {3, 4, 5, 6}), (Parts{{2, true}, {2, true}}));
    materials[6] = 1;
    EXPECT_EQ(parts_of(scene, {3, 4, 5, 6}), (Parts{{2, true}, {1, false}, {1, false}}));
    materials.assign(materials.size(), 0);
    surfaces.triangles()[0].attributes.sides = FaceSides::double_sided;
    EXPECT_EQ(parts_of(scene, {3, 4, 5, 6}), (Parts{{1, false}, {3, true}}));
    surfaces.triangles()[1].attributes.normals = 0;
    EXPECT_EQ(parts_of(scene, {3, 4, 5, 6}), (Parts{{1, false}, {1, false}, {2, true}}));
}

// Normals beyond what 32 bit offsets reach. The memory is reserved, but only a few pages of it are used.
TEST(HitPrimitives, LookUpDistantCornersOneByOne) {
    test::Random random(2);
    Surfaces surfaces(random);
    const std::size_t bytes = sizeof(Vec3f) * (std::size_t{most_lane_corners} + 4096);
    void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) GTEST_SKIP() << "the address space is limited";
    auto* normals = static_cast<Vec3f*>(memory);
    std::uint32_t next = most_lane_corners - 6;
    for (Triangle& triangle : surfaces.triangles()) {
        triangle.attributes = {next, no_attributes, FaceSides::single_sided};
        for (int i = 0; i < 3; ++i) normals[next++] = {random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), 1};
    }
    surfaces.set_normals(normals);
    compare<Plain>(surfaces, {3, 4, 5, 6}, 3);
    compare<Plain>(surfaces, {5, 4, 3, 7}, 4);
    munmap(memory, bytes);
}

}  // namespace
}  // namespace tandem
