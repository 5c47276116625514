// Every primitive is in one group, or a triangle in the groups of its pieces, with its own numbers.
#include "cpu/make_groups.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cpu/embree_handles.h"
#include "cpu/group_walk.h"
#include "support/hair.h"
#include "support/hard_scenes.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/traversal/make_node.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

constexpr float margin = 0.125F;

class Groups : public ::testing::Test {
  protected:
    [[nodiscard]] PrimitiveGroups make(const PreparedScene& scene, const CutPrimitives& cut = {}) const {
        return make_groups(device_.get(), view(scene), cut, margin);
    }

  private:
    EmbreeDevice device_{rtcNewDevice(nullptr)};
};

void expect_numbers(const BodyGroup& group, int place, const PreparedScene& scene, std::uint32_t id) {
    visit_primitive(view(scene), id, [&](const auto& primitive) {
        const Sphere around = sphere_around(primitive);
        EXPECT_EQ(group.x[place], around.centre.x);
        EXPECT_EQ(group.y[place], around.centre.y);
        EXPECT_EQ(group.z[place], around.centre.z);
        EXPECT_EQ(group.radius[place], around.radius);
    });
}
void expect_corner(const Vec3f& corner, float x, float y, float z) { EXPECT_EQ(corner, (Vec3f{x, y, z})); }
void expect_numbers(const TriangleGroup& group, int place, const PreparedScene& scene, std::uint32_t id) {
    const Triangle& t = scene.triangles.at(id - (primitive_count(scene) - scene.triangles.size() - scene.quads.size()));
    int corner = 0;
    for (const Vec3f& v : {t.v0, t.v1, t.v2}) {
        expect_corner(v, group.x[corner][place], group.y[corner][place], group.z[corner][place]);
        ++corner;
    }
}
void expect_numbers(const QuadGroup& group, int place, const PreparedScene& scene, std::uint32_t id) {
    const Quad& q = scene.quads.at(id - (primitive_count(scene) - scene.quads.size()));
    int corner = 0;
    for (const Vec3f& v : {q.v0, q.v1, q.v2, q.v3}) {
        expect_corner(v, group.x[corner][place], group.y[corner][place], group.z[corner][place]);
        ++corner;
    }
}

/// Returns the number of primitives.
template <class Group>
std::size_t check(const HugePageVector<Group>& groups, const PreparedScene& scene, std::vector<int>& seen) {
    std::size_t count = 0;
    for (const Group& group : groups) {
        EXPECT_NE(group.id[0], no_primitive);
        bool ended = false;
        for (int place = 0; place < group_size; ++place) {
            const std::uint32_t id = group.id[place];
            if (id == no_primitive) {
                ended = true;
                expect_numbers(group, place, scene, group.id[0]);
                continue;
            }
            EXPECT_FALSE(ended) << "places without a primitive come last";
            ++seen.at(id);
            ++count;
            expect_numbers(group, place, scene, id);
        }
    }
    return count;
}

const OfGroup<std::uint32_t>& ids_of(const GroupView& groups, std::uint32_t number) {
    const OfGroup<std::uint32_t>* ids = nullptr;
    visit_group(groups, number, [&](const auto& group) { ids = &group.id; });
    return *ids;
}

/// A tree of groups, from the root on.
class TreeCheck {
  public:
    TreeCheck(const PrimitiveGroups& groups, const PreparedScene& scene)
        : groups_(groups), window_(groups.view()), scene_(view(scene)), seen_(group_count(window_)) {}

    /// Returns the bounds of the primitives below a child.
    Aabb check(std::uint32_t child, int depth) {
        EXPECT_LE(depth, group_depth);
        Aabb all;
        if ((child & group_bit) != 0) {
            const std::uint32_t number = child & ~group_bit;
            ++seen_.at(number);
            for (const std::uint32_t id : ids_of(window_, number)) {
                if (id != no_primitive) all = merge(all, primitive_bounds(scene_, id));
            }
            return all;
        }
        const GroupNode& node = groups_.nodes.at(child);
        const auto& plane = node.plane;
        for (int i = 0; i < group_node_width; ++i) {
            const Aabb box = {{plane[0][i], plane[1][i], plane[2][i]}, {plane[3][i], plane[4][i], plane[5][i]}};
            if (is_empty(box)) continue;
            const Aabb inside = check(node.child[i], depth + 1);
            const Aabb padded = pad(inside, margin);
            EXPECT_EQ(box.lower, padded.lower);
            EXPECT_EQ(box.upper, padded.upper);
            all = merge(all, inside);
        }
        return all;
    }
    [[nodiscard]] bool has_seen_each_once() const {
        return std::count(seen_.begin(), seen_.end(), 1) == std::ssize(seen_);
    }

  private:
    const PrimitiveGroups& groups_;
    GroupView window_;
    SceneView scene_;
    std::vector<int> seen_;
};

void expect_all_once(const PrimitiveGroups& groups, const PreparedScene& scene, const std::string& what) {
    std::vector<int> seen(primitive_count(scene));
    const std::size_t faces = scene.triangles.size() + scene.quads.size();
    EXPECT_EQ(check(groups.bodies, scene, seen), seen.size() - faces) << what;
    EXPECT_EQ(check(groups.triangles, scene, seen), scene.triangles.size()) << what;
    EXPECT_EQ(check(groups.quads, scene, seen), scene.quads.size()) << what;
    for (std::size_t id = 0; id < seen.size(); ++id) ASSERT_EQ(seen[id], 1) << what << ", primitive " << id;
    TreeCheck tree(groups, scene);
    tree.check(groups.root, 0);
    EXPECT_TRUE(tree.has_seen_each_once()) << what;
}

TEST_F(Groups, HoldEveryPrimitiveOnce) {
    for (const test::HardScene& parameters : test::hard_scenes()) {
        const PreparedScene scene = test::make_scene(parameters, 40);
        expect_all_once(make(scene), scene, parameters.name);
    }
    for (const char* name : {"mixed/5000", "icosphere/4", "quads/1000", "spheres/1", "spheres/7", "spheres/8"}) {
        const PreparedScene scene = prepare(named_scene(name));
        expect_all_once(make(scene), scene, name);
    }
}

/// Whether a group below a child of the tree has a primitive, with a point in all boxes on the way there.
bool holds(const PrimitiveGroups& groups, std::uint32_t child, std::uint32_t id, const Vec3f& point) {
    if ((child & group_bit) != 0) {
        const auto& ids = ids_of(groups.view(), child & ~group_bit);
        return std::find(std::begin(ids), std::end(ids), id) != std::end(ids);
    }
    const GroupNode& node = groups.nodes.at(child);
    for (int i = 0; i < group_node_width; ++i) {
        bool is_inside = true;
        for (int axis = 0; axis < 3; ++axis) {
            is_inside = is_inside && node.plane[axis][i] <= point[axis] && point[axis] <= node.plane[3 + axis][i];
        }
        if (is_inside && holds(groups, node.child[i], id, point)) return true;
    }
    return false;
}

TEST_F(Groups, HoldAllPointsOfTrianglesInPieces) {
    test::Random random(12);
    const PreparedScene scene = test::hair(random, 3'000, 5);
    CutPrimitives cut;
    cut.counts.assign(scene.triangles.size(), 9);
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
        for (std::uint16_t k = 1; k < 9; ++k) cut.further.push_back({5 + i, k, 9});
    }
    const PrimitiveGroups groups = make(scene, cut);
    std::vector<int> seen(primitive_count(scene));
    (void)check(groups.triangles, scene, seen);
    EXPECT_LE(*std::max_element(seen.begin(), seen.end()), 9);
    EXPECT_GT(std::count_if(seen.begin(), seen.end(), [](int times) { return times > 5; }), 2'000);
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        const float u = random.uniform(0.0F, 1.0F), v = random.uniform(0.0F, 1 - u);
        for (const Vec3f& point : {t.v0, t.v1, t.v2, t.v0 + (t.v1 - t.v0) * u + (t.v2 - t.v0) * v}) {
            EXPECT_TRUE(holds(groups, groups.root, 5 + i, point)) << "triangle " << i;
        }
    }
}

TEST_F(Groups, HoldCoincidentPrimitives) {
    PreparedScene scene;
    scene.spheres.assign(3000, Sphere{{1, 2, 3}, 0.5F});
    scene.material_of.assign(3000, 0);
    expect_all_once(make(scene), scene, "coincident");
}

TEST_F(Groups, AreFullEnough) {
    const PreparedScene scene = prepare(named_scene("spheres/20000"));
    const PrimitiveGroups groups = make(scene);
    EXPECT_LT(groups.bodies.size(), scene.spheres.size() / 5);
    // neighbours: the spheres of a group are within a cell of a few times their mean distance
    double sum = 0;
    for (const BodyGroup& group : groups.bodies) {
        Aabb box;
        for (const float x : group.x) box = merge(box, {{x, 0, 0}, {x, 0, 0}});
        sum += widen(box.upper.x - box.lower.x);
    }
    EXPECT_LT(sum / static_cast<double>(groups.bodies.size()), 0.25) << "of 2";
}

TEST_F(Groups, AreNumberedByKind) {
    PreparedScene scene = prepare(named_scene("mixed/100"));
    scene.triangles = prepare(named_scene("triangles/50")).triangles;
    scene.quads = prepare(named_scene("quads/30")).quads;
    scene.material_of.assign(primitive_count(view(scene)), 0);
    const PrimitiveGroups groups = make(scene);
    const GroupView window = groups.view();
    EXPECT_EQ(group_count(window), groups.bodies.size() + groups.triangles.size() + groups.quads.size());
    std::vector<int> seen(primitive_count(scene));
    for (std::uint32_t number = 0; number < group_count(window); ++number) {
        for (const std::uint32_t id : ids_of(window, number)) {
            if (id != no_primitive) ++seen.at(id);
        }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 180);
}

TEST_F(Groups, AreTheSameEveryTime) {
    const PreparedScene scene = prepare(named_scene("spheres/20000"));
    const PrimitiveGroups first = make(scene), second = make(scene);
    ASSERT_EQ(first.bodies.size(), second.bodies.size());
    for (std::size_t i = 0; i < first.bodies.size(); ++i) {
        for (int place = 0; place < group_size; ++place) {
            ASSERT_EQ(first.bodies[i].id[place], second.bodies[i].id[place]);
        }
    }
}

}  // namespace
}  // namespace tandem
