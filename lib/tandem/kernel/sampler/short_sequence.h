/// A random sequence seeded from a block of the counter-based generator, for uses that need a varying number of random
/// numbers.
#pragma once

#include "tandem/kernel/sampler/philox.h"

namespace tandem {

/// Its state of 128 bits starts as four independent words, so its first three numbers are independent too. Lanes
/// advance separately, so that a packet has the numbers of single rays. Source: C. Doty-Humphrey's sfc32 ("small fast
/// chaotic"), of PractRand, 2010. Tested by tests/kernel/sampler/short_sequence_test.cpp.
template <class Real>
class ShortSequence {
  public:
    using Word = UInt<Real>;

    TANDEM_HD_INLINE explicit ShortSequence(const PhiloxBlock<Word>& start)
        : a_(start.word[0]), b_(start.word[1]), c_(start.word[2]), counter_(start.word[3]) {}

    /// The next number, 32 uniform bits, in the lanes of `takes`; the others do not advance.
    TANDEM_HD_INLINE Word next(const Mask<Real>& takes) {
        const Word result = (a_ + b_) + counter_;
        const Word a = b_ ^ (b_ >> 9);
        const Word b = c_ + (c_ << 3);
        const Word c = ((c_ << 21) | (c_ >> 11)) + result;
        a_ = select(takes, a, a_);
        b_ = select(takes, b, b_);
        c_ = select(takes, c, c_);
        counter_ = select(takes, counter_ + Word(1U), counter_);
        return result;
    }

  private:
    Word a_, b_, c_, counter_;
};

/// A start of ShortSequence whose first number is `first`, and whose later ones follow from `random`: with four
/// independent words, the first three numbers are independent.
template <class Word>
TANDEM_HD_INLINE PhiloxBlock<Word> start_with(const Word& first, const PhiloxBlock<Word>& random) {
    return {{first - random.word[1] - random.word[3], random.word[1], random.word[2], random.word[3]}};
}

}  // namespace tandem
