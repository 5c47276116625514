/// The time from the start of tandem-render until its first picture is there.
#pragma once

#include <string>

#include "tandem/report/row.h"

namespace tandem::bench {

struct FirstPictureOptions {
    std::string program;  ///< tandem-render
    std::string scene;
    std::string backend;
    std::string folder;  ///< for its files, which are removed
    int repetitions = 5;
};

/// Wall-clock seconds from starting the program, with its default settings, until it has written a PNG file and ended.
/// One run before those that count fills the cache of kernels. Its phases, as the program reports them, are beside the
/// time; those of different threads overlap. Throws EnvironmentError if the program fails.
[[nodiscard]] BenchmarkRow time_first_picture(const FirstPictureOptions& options);

}  // namespace tandem::bench
