/// Ctrl-C as a flag.
#pragma once

#include <atomic>

namespace tandem {

/// From now on the first SIGINT or SIGTERM sets the flag that is returned, and says on standard error that frames in
/// flight are being finished; a second one of the same kind ends the program by default. A signal that the program was
/// started with as ignored (nohup) stays ignored.
[[nodiscard]] const std::atomic<bool>& watch_interrupts();

}  // namespace tandem
