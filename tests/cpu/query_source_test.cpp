// The source of a ray in the CPU's tracers keeps the meaning of the kernel's: who passes the backs of culled faces.
#include "cpu/query_source.h"

#include <gtest/gtest.h>

namespace tandem {
namespace {

constexpr std::uint32_t face_id = 3;

/// The interval and the decision of a ray that hits a culled face at t = 1.
template <class From, class Face>
void expect_hit(const From& from, const Face& face, const Ray<float>& ray, bool hits) {
    const QuerySource<float> source(from);
    const StructureFrame frame = make_structure_frame(bounds(face));
    const QueryRay query = make_query_ray(propose(ray, frame, true), frame, source);
    const HitInterval interval = query_interval<float, Face>(source, face_id, query, face);
    Closest<float> best = no_hit<float>();
    test_primitive(face, face_id, ray, source, true, best);
    if (hits) {
        EXPECT_EQ(best.t, 1);
        EXPECT_LE(interval.lo, 1);
        EXPECT_LT(interval.hi, 1.001F) << "the hit is certain";
        EXPECT_GE(interval.hi, 1);
    } else {
        EXPECT_EQ(best.primitive, no_primitive);
        EXPECT_EQ(interval.lo, certain_miss.lo);
    }
}

template <class Face>
void expect_some_to_pass_the_back(Face face) {
    face.attributes.sides = FaceSides::culled;
    const Ray<float> at_front = {{0.25F, 0.5F, 1}, {0, 0, -1}}, at_back = {{0.25F, 0.5F, -1}, {0, 0, 1}};
    for (const Ray<float>& ray : {at_front, at_back}) {
        expect_hit(PathSource<float>{}, face, ray, ray.origin.z > 0);
        expect_hit(ShadowSource<float>{}, face, ray, true);
        expect_hit(CulledShadowSource<float>{}, face, ray, ray.origin.z > 0);
        expect_hit(Source<float>{}, face, ray, true);
        expect_hit(NoSource{}, face, ray, true);
        expect_hit(ShadowSource<float>{{}, face_id}, face, ray, false);
        expect_hit(CulledShadowSource<float>{{{}, face_id}}, face, ray, false);
    }
}

TEST(QuerySource, KnowsWhoPassesTheBackOfACulledTriangle) {
    expect_some_to_pass_the_back(Triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST(QuerySource, KnowsWhoPassesTheBackOfACulledQuad) {
    expect_some_to_pass_the_back(Quad{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
}

}  // namespace
}  // namespace tandem
