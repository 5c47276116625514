// A packet whose lanes have different lights gives the bits of each light alone.
#include "tandem/kernel/visit_lights.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/random.h"
#include "tandem/kernel/area_lights.h"
#include "tandem/math/lanes.h"

namespace tandem {
namespace {

/// Lights of all kinds, one of them degenerate, and boxes, which are none.
class Lights {
  public:
    explicit Lights(test::Random& random) {
        const auto point = [&] {
            return Vec3f{random.uniform(-2.0F, 2.0F), random.uniform(-2.0F, 2.0F), random.uniform(-2.0F, 2.0F)};
        };
        const auto attributes = [&] {
            FaceAttributes of_face;
            of_face.sides = static_cast<FaceSides>(random.below(3));
            return of_face;
        };
        for (int i = 0; i < 5; ++i) {
            spheres_.push_back({point(), random.uniform(0.01F, 1.5F)});
            boxes_.push_back({point(), point()});
            triangles_.push_back({point(), point(), point(), attributes()});
            quads_.push_back({point(), point(), point(), point(), attributes()});
        }
        triangles_.push_back({triangles_[0].v0, triangles_[0].v0, triangles_[0].v2, attributes()});
        view_.spheres = spheres_.data();
        view_.boxes = boxes_.data();
        view_.triangles = triangles_.data();
        view_.quads = quads_.data();
        view_.sphere_count = static_cast<std::uint32_t>(spheres_.size());
        view_.box_count = static_cast<std::uint32_t>(boxes_.size());
        view_.triangle_count = static_cast<std::uint32_t>(triangles_.size());
        view_.quad_count = static_cast<std::uint32_t>(quads_.size());
        view_.first_instanced_id = primitive_count(view_);
    }
    [[nodiscard]] const InstancedView& view() const { return view_; }

  private:
    std::vector<Sphere> spheres_;
    std::vector<Box> boxes_;
    std::vector<Triangle> triangles_;
    std::vector<Quad> quads_;
    InstancedView view_{};
};

/// What a lit point asks of a light.
template <class Real>
struct Answers {
    Mask<Real> is_visited = Mask<Real>(false), shines = Mask<Real>(false);
    Vec3<Double<Real>> direction{}, point{};
    Double<Real> pdf{}, pdf_of_direction{};
};

template <class Real>
Answers<Real> ask(const SceneView& scene, const UInt<Real>& primitive, const Mask<Real>& active, const Vec3d& point,
                  double u, double v) {
    using D = Double<Real>;
    // so that only some of the quads have halves that overlap
    const UInt<Real> middle_quad(primitive_count(scene) - 3);
    Answers<Real> answers;
    visit_lights<Real>(scene, primitive, active, [&](const auto& light, const Mask<Real>& here) {
        const Vec3<D> from = broadcast<D>(point);
        const auto view = area_lights_detail::view_light<Real>(light, from, primitive < middle_quad);
        const LightSample<Real> sample = sample_light(view, D(u), D(v));
        answers.is_visited = answers.is_visited || here;
        answers.shines = answers.shines || (here && area_lights_detail::shines<Real>(light, from, sample.direction));
        answers.direction = select(here, sample.direction, answers.direction);
        answers.point = select(here, sample.point, answers.point);
        answers.pdf = select(here, sample.pdf, answers.pdf);
        answers.pdf_of_direction = select(here, pdf_of(view, sample.direction), answers.pdf_of_direction);
    });
    return answers;
}

/// Also equal for a NaN, from a degenerate face.
void expect_equal_bits(double a, double b, const std::string& where) { EXPECT_EQ(bits_of(a), bits_of(b)) << where; }

template <class Real>
void compare(std::uint64_t seed) {
    using Packet = Lanes<Real, Sse4>;
    test::Random random(seed);
    const Lights lights(random);
    const Vec3d point = {random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)};
    const double u = random.uniform(0.0, 1.0), v = random.uniform(0.0, 1.0);
    UInt<Packet> primitive(0U), is_active(0U);
    for (int i = 0; i < Packet::size; ++i) {
        set_lane(primitive, i, random.below(primitive_count(lights.view())));
        set_lane(is_active, i, random.below(4) == 0 ? 0U : 1U);
    }
    const Mask<Packet> active = is_active != UInt<Packet>(0U);
    const auto together = ask<Packet>(lights.view(), primitive, active, point, u, v);
    for (int i = 0; i < Packet::size; ++i) {
        const auto alone = ask<Real>(lights.view(), primitive[i], active[i], point, u, v);
        const std::string where = "seed " + std::to_string(seed) + ", lane " + std::to_string(i) + ", primitive " +
                                  std::to_string(primitive[i]);
        EXPECT_EQ(together.is_visited[i], alone.is_visited) << where;
        EXPECT_EQ(together.shines[i], alone.shines) << where;
        if (!alone.is_visited) continue;
        expect_equal_bits(together.direction.x[i], alone.direction.x, where);
        expect_equal_bits(together.direction.y[i], alone.direction.y, where);
        expect_equal_bits(together.direction.z[i], alone.direction.z, where);
        expect_equal_bits(together.point.x[i], alone.point.x, where);
        expect_equal_bits(together.point.y[i], alone.point.y, where);
        expect_equal_bits(together.point.z[i], alone.point.z, where);
        expect_equal_bits(together.pdf[i], alone.pdf, where);
        expect_equal_bits(together.pdf_of_direction[i], alone.pdf_of_direction, where);
    }
}

TEST(VisitLights, GivesTheBitsOfEachLightAlone) {
    for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
        compare<float>(seed);
        compare<double>(seed);
        if (HasFailure()) return;
    }
}

}  // namespace
}  // namespace tandem
