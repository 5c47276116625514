/// The time of a frame of whitted.gltf on the CPU, beside the same scene in Mitsuba 3.
#pragma once

#include <array>
#include <string>

#include "tandem/report/row.h"

namespace tandem::bench {

struct BesideMitsubaOptions {
    std::string script;    ///< scripts/versus_mitsuba.py
    std::string renderer;  ///< tandem-render
    std::string variant;   ///< of Mitsuba: "scalar_rgb"
    std::string folder;    ///< for a file, which is removed
    int threads = 2;
    int repetitions = 5;
};

struct BesideMitsuba {
    std::string why_not;               ///< why it was not measured; empty if it was
    std::array<BenchmarkRow, 2> rows;  ///< Mitsuba, Tandem in strict
};

/// Runs the script, which times both in turns, with python3.
[[nodiscard]] BesideMitsuba time_beside_mitsuba(const BesideMitsubaOptions& options);

}  // namespace tandem::bench
