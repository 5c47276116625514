/// Ctrl-C as a flag.
#pragma once

#include <atomic>

namespace tandem {

/// From now on the first SIGINT or SIGTERM sets the returned flag and prints a message: what is in flight is finished.
/// A second one of the same kind ends the program. A signal that was ignored when the program started (nohup) stays
/// ignored.
[[nodiscard]] const std::atomic<bool>& watch_interrupts();

}  // namespace tandem
