/// Runs other programs.
#pragma once

#include <string>
#include <vector>

namespace tandem::bench {

/// Runs a program, by path or by its name in PATH, to its end; its output goes where that of this program goes. Returns
/// its exit status; as a shell does, 127 if it cannot be started, and 128 and the signal if a signal ends it.
[[nodiscard]] int run_program(std::vector<std::string> words);

/// The path of tandem-render beside the running program; empty if it is not there.
[[nodiscard]] std::string renderer_beside();

}  // namespace tandem::bench
