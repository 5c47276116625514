// For a build without the corpus, or without the libraries that it needs.
#include "hard.h"
#include "tandem/base/error.h"

namespace tandem::bench {

bool run_hard(const HardOptions&, const BackendSource&, Report&) {
    throw EnvironmentError(
        "this build has no corpus of hard cases, which scripts/bench leaves out. scripts/build builds it; its exact "
        "answers "
        "need MPFR, GMP and Boost.Multiprecision (on Debian and Ubuntu libmpfr-dev, libgmp-dev and libboost-dev)");
}

}  // namespace tandem::bench
