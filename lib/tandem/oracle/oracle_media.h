/// The media around a path of the oracle, and their interfaces.
#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

#include "tandem/kernel/media/medium_stack.h"  // for no_medium alone
#include "tandem/oracle/oracle_geometry.h"

namespace tandem::oracle {

/// The media that a path is inside of, by material, in the order of entering.
class Media {
  public:
    explicit Media(const SceneView& scene) : optics_(scene.optics) {
        inside_.assign(scene.camera_media.material, scene.camera_media.material + scene.camera_media.count);
    }
    [[nodiscard]] std::uint32_t current() const {
        std::uint32_t best = no_medium;
        for (const std::uint32_t medium : inside_) {
            if (best == no_medium || priority(medium) >= priority(best)) best = medium;
        }
        return best;
    }
    void cross(std::uint32_t material, bool from_inside) {
        if (!from_inside) {
            if (inside_.size() < 8) inside_.push_back(material);
            return;
        }
        const auto last = std::find(inside_.rbegin(), inside_.rend(), material);
        if (last != inside_.rend()) inside_.erase(std::next(last).base());
    }

  private:
    [[nodiscard]] std::uint32_t priority(std::uint32_t medium) const { return optics_[medium].priority; }
    const Optics* optics_;
    std::vector<std::uint32_t> inside_;
};

/// The index of refraction; 1 outside of all media.
[[nodiscard]] Real index_of(const SceneView& scene, std::uint32_t medium);

/// Snell's law and Fresnel's equations, by angles. Returns the reflectance; 1 for total internal reflection.
[[nodiscard]] Real refract(const Vector& d, const Vector& n, Real from, Real to, Vector& onward);

}  // namespace tandem::oracle
