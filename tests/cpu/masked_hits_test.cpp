// Packets of shadow rays through alpha masks and culled faces: one search through Embree against searches for one hit
// after the other.
#include "tandem/kernel/masked_hits.h"

#include <gtest/gtest.h>

#include "cpu/embree_handles.h"
#include "cpu/embree_tracer.h"
#include "support/masked_faces.h"

namespace tandem {
namespace {

/// A scene whose primitives are user geometry of Embree, as in the tiers strict and precise.
template <class Packet>
struct EmbreeCase {
    EmbreeCase(RTCDevice device, const PreparedScene& prepared) : embree(rtcNewScene(device)) {
        view.scene = tandem::view(prepared);
        const std::uint32_t count = primitive_count(view.scene);
        Aabb box;
        for (std::uint32_t id = 0; id < count; ++id) box = merge(box, primitive_bounds(view.scene, id));
        view.frame = make_structure_frame(box);
        view.first_id[embree_quads] = count - view.scene.quad_count;
        view.first_id[embree_triangles] = count - view.scene.quad_count - view.scene.triangle_count;
        const EmbreeGeometry geometry = user_geometry(device, &view, count);
        rtcSetGeometryBoundsFunction(geometry.get(), padded, nullptr);
        rtcSetGeometryIntersectFunction(geometry.get(), intersect_callback<Scalar<Packet>, Packet>);
        rtcSetGeometryOccludedFunction(geometry.get(), occluded_callback<Scalar<Packet>, Packet>);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometryByID(embree.get(), geometry.get(), our_primitives);
        rtcCommitScene(embree.get());
        check_embree(device, "building a test");
        view.embree = embree.get();
    }

    static void padded(const RTCBoundsFunctionArguments* args) {
        const auto& of = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
        const Aabb box = pad(primitive_bounds(of.scene, args->primID), of.frame.padding);
        *args->bounds_o = {box.lower.x, box.lower.y, box.lower.z, 0, box.upper.x, box.upper.y, box.upper.z, 0};
    }

    CpuSceneView view{};
    EmbreeScene embree;
};

template <class Packet>
void expect_one_search_to_do() {
    using One = Scalar<Packet>;
    const EmbreeDevice device(rtcNewDevice(nullptr));
    int blocked = 0, rays = 0;
    for (std::uint64_t number = 0; number < 2000; ++number) {
        test::Random random(number);
        PreparedScene prepared = test::any_faces(random, 12);
        test::mask_some(prepared, random);
        const EmbreeCase<Packet> scene(device.get(), prepared);
        ShadowRay<One> one[Packet::size];
        ShadowRay<Packet> packet;
        packet.active = Mask<Packet>(false);
        UInt<Packet> lanes;
        for (int i = 0; i < Packet::size; ++i) {
            one[i] = test::any_shadow_ray<One>(prepared, random);
            one[i].active = one[i].active && random.below(8) != 0;
            for (int axis = 0; axis < 3; ++axis) {
                packet.ray.origin[axis].set(i, one[i].ray.origin[axis]);
                packet.ray.direction[axis].set(i, one[i].ray.direction[axis]);
            }
            packet.source.primitive.set(i, one[i].source.primitive);
            packet.source.light.set(i, one[i].source.light);
            packet.t_max.set(i, one[i].t_max);
            lanes.set(i, one[i].active ? 1U : 0U);
        }
        packet.active = lanes == UInt<Packet>(1U);
        CpuMaskedHits<Packet> hits(scene.view.scene, packet);
        const QuerySource<Packet> source(MaskedShadowSource<Packet>{packet.source, packet.source.light});
        const Mask<Packet> found =
            EmbreeTracer{scene.view}.occluded(packet.ray, packet.t_max, source, packet.active, &hits);
        for (int i = 0; i < Packet::size; ++i) {
            if (!one[i].active) continue;
            ASSERT_EQ(found[i], test::is_blocked_one_by_one(scene.view.scene, one[i])) << number << ", lane " << i;
            ++rays;
            if (found[i]) ++blocked;
        }
    }
    EXPECT_GT(blocked, rays / 4);
    EXPECT_LT(blocked, rays / 4 * 3);
}

TEST(MaskedHits, NeedOneSearchThroughEmbreeInStrict) { expect_one_search_to_do<Lanes<float, Sse4>>(); }
TEST(MaskedHits, NeedOneSearchThroughEmbreeInPrecise) { expect_one_search_to_do<Lanes<double, Sse4>>(); }

}  // namespace
}  // namespace tandem
