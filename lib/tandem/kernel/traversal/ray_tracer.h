/// Code that the tracers that follow one ray at a time share.
#pragma once

#include "tandem/kernel/traversal/intersect.h"

namespace tandem {

/// A tracer from a structure that finds hits: Structure::find<search>(ray, source, best) tests what the ray may hit,
/// and keeps the best. A search for any hit may end at the first that is nearer than where `best` started.
template <class Structure>
struct RayTracer : Structure {
    /// As LoopTracer::closest().
    template <class Real, class From>
    TANDEM_HD_INLINE Closest<Real> closest(const Ray<Real>& ray, const From& source, bool active,
                                           const Double<Real>& farthest = no_hit<Real>().t) const {
        Closest<Real> best = {farthest, no_primitive};
        if (active) Structure::template find<Search::nearest>(ray, source, best);
        return best;
    }

    /// As LoopTracer::occluded().
    template <class Real, class From>
    TANDEM_HD_INLINE bool occluded(const Ray<Real>& ray, const Double<Real>& t_max, const From& source,
                                   bool active) const {
        Closest<Real> best = closest_starting_at<Real>(t_max);
        if (active) Structure::template find<Search::any>(ray, source, best);
        return best.t < t_max;
    }
};

}  // namespace tandem
