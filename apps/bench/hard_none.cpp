// For a build without the corpus, or without the libraries that it needs.
#include "hard.h"
#include "tandem/base/error.h"

namespace tandem::bench {

bool run_hard(const HardOptions&, const BackendSource&, Report&) {
    throw EnvironmentError(
        "this build has no corpus of hard cases: scripts/bench leaves it out, and its exact answers need MPFR, GMP and "
        "Boost.Multiprecision. On Debian and Ubuntu install libmpfr-dev, libgmp-dev and libboost-dev; then run "
        "scripts/build, or configure with -DTANDEM_HARD_CASES=ON and build");
}

}  // namespace tandem::bench
