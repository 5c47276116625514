/// tandem-bench parity: compares the films of all backends and variants.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "backend_source.h"
#include "common/arguments.h"
#include "tandem/film/film.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct ParityOptions {
    std::vector<std::string> scenes = {"named:paper", "named:mixed/10000", "named:spheres/1000000"};
    std::vector<std::string> backends = {"cpu", "cuda", "oracle"};
    std::vector<std::string> tiers = {"strict", "precise"};  ///< only tiers that guarantee equal bits
    FrameRange frames{0, 0};
    FilmSize size{1000, 900};
    int samples = 4;
    std::uint64_t seed = 0;
};

/// A way to render that must not change the image.
struct ParityVariant {
    std::string label;
    std::string backend;
    BackendOptions options;
};

/// For the CPU: 1, 2 and 7 threads, tiles of 8, 16 and 13 pixels, and every instruction set of this machine; one
/// variant each for the other backends.
[[nodiscard]] std::vector<ParityVariant> parity_variants(const std::vector<std::string>& backends,
                                                         const std::vector<std::string>& instruction_sets);

/// Renders and compares; fills `report`. Throws InputError for a tier that does not guarantee equal bits. True if all
/// films of backends that guarantee them are equal. The others (the oracle) are compared by tolerance and only
/// reported.
[[nodiscard]] bool run_parity(const ParityOptions& options, const BackendSource& source, Report& report);

}  // namespace tandem::bench
