/// Raw Embree, as a program without Tandem would use it: a baseline for rays per second and for correct answers.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "tandem/kernel/shapes/hit.h"
#include "tandem/kernel/shapes/sphere.h"
#include "tandem/kernel/shapes/triangle.h"
#include "tandem/math/ray.h"

namespace tandem::bench {

/// The flags of an Embree scene: fast, or fewer leaks between triangles (RTC_SCENE_FLAG_ROBUST).
enum class EmbreeFlags { plain, robust };

/// Embree's own geometry (RTC_GEOMETRY_TYPE_SPHERE_POINT, _TRIANGLE) and one rtcIntersect1 per ray, blocks of rays
/// shared among the threads by TBB. Its hits are Embree's: approximate, and different from processor to processor.
class EmbreeNative {
  public:
    /// threads: 0 means one per core. Builds the scene. Throws EnvironmentError if Embree does.
    EmbreeNative(std::span<const Sphere> spheres, int threads, EmbreeFlags flags = EmbreeFlags::plain);
    EmbreeNative(std::span<const Triangle> triangles, int threads, EmbreeFlags flags = EmbreeFlags::plain);
    ~EmbreeNative();
    EmbreeNative(const EmbreeNative&) = delete;
    EmbreeNative& operator=(const EmbreeNative&) = delete;

    /// Nearest hits; sizes must be equal. Returns the seconds that it took.
    double trace(std::span<const Ray<float>> rays, std::span<Hit> hits);

    [[nodiscard]] double build_seconds() const;
    [[nodiscard]] static std::string version();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tandem::bench
