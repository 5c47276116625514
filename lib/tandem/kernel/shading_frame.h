/// The normals and directions at a vertex of a path.
#pragma once

#include "tandem/kernel/surface.h"
#include "tandem/math/frame.h"

namespace tandem {

template <class Real>
struct ShadingFrame {
    Vec3<Double<Real>> to_viewer;  ///< unit
    LobeNormals<Real> normals;
    Mask<Real> from_inside;  ///< the ray comes against the outward normal
    Mask<Real> is_front;     ///< the outward shading normal is on the ray's side: there light is scattered
};

template <class Real>
TANDEM_HD ShadingFrame<Real> make_shading_frame(const Surface<Real>& surface, const SurfacePoint<Real>& point,
                                                const Vec3<Double<Real>>& to_viewer) {
    ShadingFrame<Real> shading;
    shading.to_viewer = to_viewer;
    shading.from_inside = point.from_inside;
    const Mask<Real> away = dot(-to_viewer, surface.normal) > Double<Real>(0.0);
    shading.normals = {select(away, -surface.normal, surface.normal),
                       select(shading.from_inside, -point.normal, point.normal)};
    shading.is_front = !away;
    return shading;
}

/// The local frame of lobes, and the viewer there.
template <class Real>
struct LocalView {
    Frame<Double<Real>> frame;
    Vec3<Double<Real>> wo;  ///< to the viewer, unit, above the surface
    Mask<Real> hidden;      ///< on the back of a single-sided surface, which is black
};

/// Where microfacets are anisotropic, x is the direction in which they are rougher; elsewhere it does not matter.
///
/// Where interpolation or a normal map turns the shading normal away from a viewer who is in front of the surface, the
/// surface looks as if seen from the same angle in front of it: otherwise silhouettes would have black borders.
template <class Effects, class Real>
TANDEM_HD LocalView<Real> local_view(const Surface<Real>& surface, const SurfacePoint<Real>& point,
                                     const Vec3<Double<Real>>& to_viewer) {
    using D = Double<Real>;
    LocalView<Real> view;
    view.frame = frame_around(surface.normal);
    if (Effects::has(Effect::anisotropy) && any(surface.anisotropic)) {
        const Vec3<D> bitangent = cross(surface.normal, surface.tangent);
        view.frame.tangent = select(surface.anisotropic, surface.tangent, view.frame.tangent);
        view.frame.bitangent = select(surface.anisotropic, bitangent, view.frame.bitangent);
    }
    view.wo = to_frame(view.frame, to_viewer);
    view.hidden = view.wo.z < D(0.0F) && point.from_inside;
    view.wo.z = greater(absolute(view.wo.z), D(0x1p-30F));
    return view;
}

}  // namespace tandem
