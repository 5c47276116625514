/// Tables in memory that each lane of a packet reads, or searches, at a place of its own. Tested by
/// tests/math/lookup_table_test.cpp and lanes_test.cpp.
#pragma once

#include "tandem/math/real.h"

namespace tandem {

namespace lookup_table_detail {

/// Numbers of type T in the lanes of `Word`.
template <class T, class Word>
struct InLanesOf {
    using type = std::conditional_t<std::is_same_v<T, float>, Float<Word>,
                                    std::conditional_t<std::is_same_v<T, double>, Wide<Word>, UInt<Word>>>;
};
template <class T>
struct InLanesOf<T, std::uint32_t> {
    using type = T;
};

}  // namespace lookup_table_detail

/// The first of `count` consecutive places of which is_before(place) does not hold, or else the last one. Needs: count
/// > 0; is_before() holds of no place that follows one of which it does not. Bisects without a branch on the table, so
/// that all lanes and threads take the same steps.
template <class Word, class IsBefore>
TANDEM_HD_INLINE Word bisect(std::uint32_t count, IsBefore is_before) {
    Word first(0U);
    for (std::uint32_t rest = count; rest > 1;) {
        const std::uint32_t half = rest / 2;
        first = select(is_before(first + Word(half - 1)), first + Word(half), first);
        rest -= half;
    }
    return first;
}

/// Rows of entries, one row after the other. `step`: the number of T's from an entry to the next; its first one is
/// read. T is float, double or std::uint32_t.
template <class T, std::uint32_t step = 1>
struct LookupTable {
    const T* numbers;  ///< the first of entry (0, 0); memory of the reader: host or device
    std::uint32_t width;
    std::uint32_t height = 1;

    /// Needs: row < height and column < width, in all lanes.
    template <class Word>
    TANDEM_HD_INLINE typename lookup_table_detail::InLanesOf<T, Word>::type at(const Word& row,
                                                                               const Word& column) const {
        if constexpr (std::is_same_v<Word, std::uint32_t>) {
            return numbers[(static_cast<std::size_t>(row) * width + column) * step];
        } else {
            using Numbers = typename lookup_table_detail::InLanesOf<T, Word>::type;
            // packets have offsets of 32 bits, with a sign
            if (static_cast<std::size_t>(width) * height <= 0x7FFFFFFFU / (step * sizeof(T))) [[likely]] {
                return Numbers::gather(numbers, (row * Word(width) + column) * Word(step * sizeof(T)));
            }
            return Numbers::from([&](int i) { return at(lane(row, i), lane(column, i)); });
        }
    }
    /// In the first row.
    template <class Word>
    TANDEM_HD_INLINE typename lookup_table_detail::InLanesOf<T, Word>::type operator[](const Word& column) const {
        return at(Word(0U), column);
    }
};

}  // namespace tandem
