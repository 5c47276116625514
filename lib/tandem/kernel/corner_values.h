/// Texture coordinates and colours at a hit, interpolated between the corners of faces.
#pragma once

#include "tandem/kernel/hit_primitives.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// The parametrisation() of a part of for_each_part(), from the values of faces in `slot`.
template <std::uint32_t kinds, class Real, class Part>
TANDEM_HD_CALL Parametrisation<Real> parametrisation_of(const SceneView& scene, Part part, std::uint32_t slot,
                                                        HitRecord<Real> record, Ray<Real> ray, Double<Real> t,
                                                        Mask<Real> here) {
    Parametrisation<Real> at;
    visit_primitive<kinds>(scene, part, [&](const auto& body) {
        using Body = std::decay_t<decltype(body)>;
        const std::uint32_t first = slot * corner_count<Body>;
        at = parametrisation(body, record, scene.texcoords + first, ray, t, here);
    });
    return at;
}

/// The values of a part's slots at the hit at `t`, in the lanes of `here`. Caches the last slot, because most materials
/// use one slot several times.
template <std::uint32_t kinds, class Real, class Part>
class CornerValues {
  public:
    TANDEM_HD CornerValues(const SceneView& scene, const Part& part, const HitRecord<Real>& record,
                           const Ray<Real>& ray, const Double<Real>& t, const Mask<Real>& here)
        : scene_(scene), part_(part), record_(record), ray_(ray), t_(t), here_(here) {}

    [[nodiscard]] TANDEM_HD const Parametrisation<Real>& in(std::uint32_t slot) {
        if (!may_have_several_slots()) slot = 0;
        if (slot != slot_) {
            at_ = parametrisation_of<kinds, Real, Part>(scene_, part_, slot, record_, ray_, t_, here_);
            slot_ = slot;
        }
        return at_;
    }

    /// A texture of the material.
    [[nodiscard]] TANDEM_HD Rgba<Real> texture(const TextureUse& use) {
        const Parametrisation<Real>& at = in(use.slot);
        return sample<Real>(scene_.textures, use, at.u, at.v);
    }

    /// Interpolated red, green, blue and alpha of a face's corners (MaterialTextures::colour_slot).
    [[nodiscard]] TANDEM_HD Rgba<Real> colour(std::uint32_t slot) {
        // rounding may make the sum of the corners' weights differ from 1
        const auto share = [](const Double<Real>& a) {
            return to_real<Real>(parametrisation_detail::clamp_to_one<Real>(a));
        };
        const Real r = share(in(slot).u);
        const Real g = share(in(slot).v);
        return {r, g, share(in(slot + 1).u), share(in(slot + 1).v)};
    }

  private:
    const SceneView& scene_;
    const Part& part_;
    const HitRecord<Real>& record_;
    const Ray<Real>& ray_;
    const Double<Real>& t_;
    const Mask<Real>& here_;
    std::uint32_t slot_ = no_slot;
    Parametrisation<Real> at_;
};

/// The base colour and alpha of a material: its texture times the colours of a face's corners. White without any. glTF
/// 2.0, 3.9.2.
template <std::uint32_t kinds, class Real, class Part>
TANDEM_HD Rgba<Real> base_colour(const MaterialTextures& textures, bool on_face,
                                 CornerValues<kinds, Real, Part>& values) {
    const Real one(1.0F);
    Rgba<Real> colour = {one, one, one, one};
    if (textures.diffuse.texture != no_texture) colour = values.texture(textures.diffuse);
    if (may_have_several_slots() && on_face && textures.colour_slot != no_slot) {
        const Rgba<Real> corners = values.colour(textures.colour_slot);
        colour = {colour.r * corners.r, colour.g * corners.g, colour.b * corners.b, times_alpha(colour.a, corners.a)};
    }
    return colour;
}

}  // namespace tandem
