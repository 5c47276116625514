// For a build without the libraries that the corpus needs.
#include "hard.h"
#include "tandem/base/error.h"

namespace tandem::bench {

bool run_hard(const HardOptions&, const BackendSource&, Report&) {
    throw EnvironmentError(
        "this build has no corpus of hard cases: its exact answers need MPFR, GMP and Boost.Multiprecision (on Debian "
        "and Ubuntu libmpfr-dev, libgmp-dev and libboost-dev); install them, configure and build again");
}

}  // namespace tandem::bench
