/// The medium at a point where dielectric solids are nested or overlap.
#pragma once

#include <cstdint>
#include <tuple>

#include "tandem/math/real.h"

namespace tandem {

/// Outside of all solids.
inline constexpr std::uint32_t no_medium = 0xFFFFFFFFU;

/// The media that a path has entered and not left.
///
/// Every medium has a priority. Where solids overlap, the medium of the highest priority fills the space; on equal
/// priorities, the one entered last. So a solid inside another needs no priorities. Water that overlaps the glass
/// around it, to leave no gap, needs a lower priority than the glass. Interfaces at the same t are crossed in the order
/// of their primitives' ids, like hits.
///
/// Needs: media below 2^24, priorities below 2^7. Paths leave a medium as often as they enter it, in any order with
///        other media; solids of the same medium may overlap.
/// Source: C. Schmidt, B. Budge, "Simple Nested Dielectrics in Ray Traced Images", Journal of Graphics Tools 7(2),
/// 2002. Tested by tests/kernel/media/medium_stack_test.cpp and F8 of the corpus (tests/hard).
template <class Real>
class MediumStack {
  public:
    using Word = UInt<Real>;
    static constexpr int capacity = 8;

    TANDEM_HD_INLINE MediumStack() {
        for (Word& entry : entries_) entry = Word(empty);
    }

    /// Returns the lanes of `active` whose stack is full; they stay unchanged.
    TANDEM_HD_INLINE Mask<Real> enter(const Word& medium, const Word& priority, const Mask<Real>& active) {
        const Word entry = (priority << medium_bits) | medium;
        Mask<Real> waiting = active;
        for (Word& place : entries_) {
            const Mask<Real> here = waiting && place == Word(empty);
            place = select(here, entry, place);
            waiting = waiting && !here;
        }
        return waiting;
    }

    /// Removes the last entry of the medium. Returns the lanes of `active` that were not in this medium; they stay
    /// unchanged.
    TANDEM_HD_INLINE Mask<Real> leave(const Word& medium, const Mask<Real>& active) {
        const Word nowhere(static_cast<std::uint32_t>(capacity));
        Word last = nowhere;
        for (int i = 0; i < capacity; ++i) {
            const Mask<Real> match = entries_[i] != Word(empty) && (entries_[i] & Word(medium_mask)) == medium;
            last = select(match, Word(static_cast<std::uint32_t>(i)), last);
        }
        for (int i = 0; i < capacity; ++i) {
            const Mask<Real> moves = active && !(Word(static_cast<std::uint32_t>(i)) < last);
            entries_[i] = select(moves, i + 1 < capacity ? entries_[i + 1] : Word(empty), entries_[i]);
        }
        return active && last == nowhere;
    }

    /// The medium that fills the current point, or no_medium.
    [[nodiscard]] TANDEM_HD_INLINE Word current() const {
        Word best(empty);
        for (const Word& entry : entries_) {
            const Mask<Real> filled = entry != Word(empty);
            const Mask<Real> wins = filled && (best == Word(empty) || (best >> medium_bits) <= (entry >> medium_bits));
            best = select(wins, entry, best);
        }
        return select(best == Word(empty), Word(no_medium), best & Word(medium_mask));
    }

    /// References to all values per lane.
    TANDEM_HD_INLINE auto per_lane() {
        auto& [a, b, c, d, e, f, g, h] = entries_;
        return std::tie(a, b, c, d, e, f, g, h);
    }

    /// `a` in the lanes of `mask`, else `b`.
    TANDEM_HD_INLINE friend MediumStack select(const Mask<Real>& mask, const MediumStack& a, const MediumStack& b) {
        MediumStack result;
        for (int i = 0; i < capacity; ++i) result.entries_[i] = select(mask, a.entries_[i], b.entries_[i]);
        return result;
    }

    /// Whether both have the same media in the same order.
    TANDEM_HD_INLINE friend Mask<Real> operator==(const MediumStack& a, const MediumStack& b) {
        Mask<Real> same(true);
        for (int i = 0; i < capacity; ++i) same = same && a.entries_[i] == b.entries_[i];
        return same;
    }

  private:
    static constexpr int medium_bits = 24;
    static constexpr std::uint32_t medium_mask = (1U << medium_bits) - 1;
    static constexpr std::uint32_t empty = 0xFFFFFFFFU;

    Word entries_[capacity];  ///< in the order of entering, without gaps
};

}  // namespace tandem
