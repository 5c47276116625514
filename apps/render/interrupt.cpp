#include "render/interrupt.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string_view>

namespace tandem {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not take locks");

void on_signal(int) {
    constexpr std::string_view message = "\nfinishing what is in progress; press again to stop at once\n";
    const int error = errno;
    interrupted = true;
    if (::write(STDERR_FILENO, message.data(), message.size()) < 0) {
        // there is no way to report it
    }
    errno = error;
}

}  // namespace

const std::atomic<bool>& watch_interrupts() {
    interrupted = false;
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction before = {};
        ::sigaction(signal, nullptr, &before);
        if (before.sa_handler == SIG_IGN) continue;
        struct sigaction action = {};
        action.sa_handler = on_signal;
        action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
        ::sigaction(signal, &action, nullptr);
    }
    return interrupted;
}

}  // namespace tandem
