/// Random numbers of the oracle.
#pragma once

#include <algorithm>
#include <cmath>

#include "tandem/kernel/sampler/dimensions.h"
#include "tandem/oracle/oracle_geometry.h"

namespace tandem::oracle {

/// Separate random numbers in [0, 1), for quantities that the oracle estimates in another way than the backends.
class Chance {
  public:
    Chance(const SampleId<float>& sample, std::uint32_t vertex) : sample_(sample), vertex_(vertex) {}
    Real operator()() {
        if (next_ % 4 == 0) block_ = sample_.random_block(static_cast<Dimension>(128 + next_ / 4), vertex_);
        return Real{to_unit_interval<float>(block_.word[next_++ % 4])};
    }

  private:
    SampleId<float> sample_;
    std::uint32_t vertex_;
    std::uint32_t next_ = 0;
    PhiloxBlock<std::uint32_t> block_{};
};

/// Uniform on the hemisphere around n.
inline Vector on_hemisphere(const Vector& n, Chance& chance) {
    const Real z = 2 * chance() - 1, angle = 2 * pi * chance();
    const Real r = std::sqrt(std::max<Real>(0, 1 - z * z));
    const Vector d = {r * std::cos(angle), r * std::sin(angle), z};
    return inner(d, n) < 0 ? d * -1 : d;
}

}  // namespace tandem::oracle
