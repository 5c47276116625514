/// The primitives that a traversal keeps until it decides.
#pragma once

#include "tandem/kernel/traversal/hit_interval.h"

namespace tandem {

/// Up to `most` primitives that may be hit at or before a limit that only falls. The first place is free only if all
/// are.
template <int most>
struct Candidates {
    float lo[most];
    std::uint32_t id[most];
    std::uint32_t overflow = 0;  ///< 1 if there was no place for some primitive

    TANDEM_HD_INLINE Candidates() {
        for (int k = 0; k < most; ++k) {
            lo[k] = interval_detail::infinity;
            id[k] = 0;
        }
    }

    /// Keeps a primitive that may be hit at `from` <= limit. Places whose primitives are beyond the limit are free.
    TANDEM_HD_INLINE void add(float from, std::uint32_t primitive, float limit) {
        bool placed = false;
        for (int k = 0; k < most; ++k) {
            const bool here = !placed && !(lo[k] <= limit);
            lo[k] = here ? from : lo[k];
            id[k] = here ? primitive : id[k];
            placed = placed || here;
        }
        overflow = placed ? overflow : 1U;
    }

    /// Removes and returns the first one that may be hit at or before the limit; no_primitive if there is none.
    TANDEM_HD_INLINE std::uint32_t take(float limit) {
        std::uint32_t taken = no_primitive;
        for (int k = 0; k < most; ++k) {
            if (taken == no_primitive && lo[k] <= limit) taken = id[k];
            if (taken == no_primitive) continue;
            lo[k] = k + 1 < most ? lo[k + 1] : interval_detail::infinity;
            id[k] = k + 1 < most ? id[k + 1] : 0;
        }
        return taken;
    }

    /// Whether there is no place for another one.
    [[nodiscard]] TANDEM_HD_INLINE bool is_full(float limit) const {
        bool full = true;
        for (int k = 0; k < most; ++k) full = full && lo[k] <= limit;
        return full;
    }

    /// Calls decide(primitive) for those that may be hit at or before the limit. In one place of the code, so that all
    /// threads of a warp decide together.
    template <class Decide>
    TANDEM_HD_INLINE void for_each(float limit, const Decide& decide) {
        TANDEM_KEEP_LOOP
        for (int rest = most; rest > 0 && lo[0] < interval_detail::infinity; --rest) {
            if (lo[0] <= limit) decide(id[0]);
            for (int k = 1; k < most; ++k) {
                lo[k - 1] = lo[k];
                id[k - 1] = id[k];
            }
            lo[most - 1] = interval_detail::infinity;
        }
    }
};

}  // namespace tandem
