/// Estimates the brightness of an emissive texture over a light.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// Estimates for choosing among lights: a light's probability changes the noise of an image and not its mean, as long
/// as every emitter has one.
class EmissiveTextures {
  public:
    /// `scene` must outlive it.
    explicit EmissiveTextures(const SceneView& scene) : scene_(scene) {}

    /// Approximately the mean of the texture (over red, green and blue too) on a primitive; 0 only if all of it is
    /// black. 1 without a texture.
    [[nodiscard]] double brightness(std::uint32_t primitive);

  private:
    /// Summed-area table of the blocks of texels that are not black.
    struct Blocks {
        std::size_t columns = 0;
        std::vector<std::uint32_t> bright;
        [[nodiscard]] bool any(std::size_t x0, std::size_t x1, std::size_t y0, std::size_t y1) const;
    };
    const Blocks& blocks_of(std::uint32_t texture);
    /// Coordinates on the texture.
    struct Point {
        double u, v;
    };
    /// Whether the texture may be other than black in the bounding box of some points.
    bool may_shine(const TextureUse& use, std::span<const Point> points);
    double on_triangle(const TextureUse& use, const Vec2f& a, const Vec2f& b, const Vec2f& c);
    double on_sphere(const TextureUse& use);
    [[nodiscard]] double level_at(const TextureUse& use, const Point& surface) const;

    SceneView scene_;
    std::map<std::uint32_t, Blocks> blocks_;  ///< by texture
};

}  // namespace tandem
