/// The exit statuses of Tandem's programs.
#pragma once

#include <cstdio>
#include <exception>
#include <new>

#include "tandem/base/error.h"

namespace tandem {

/// Described by --help.
enum ExitStatus : int { exit_done = 0, exit_short_of_target = 1, exit_bad_input = 2, exit_environment = 3 };

/// Runs `body`, which returns an exit status, and turns its exceptions into one line on standard error,
/// "PROGRAM: message", and a status: InputError 2, EnvironmentError and lack of memory 3, anything else 1.
template <class Body>
int run_main(const char* program, Body body) {
    const auto report = [&](const char* message, int status) {
        std::fprintf(stderr, "%s: %s\n", program, message);
        return status;
    };
    try {
        return body();
    } catch (const InputError& error) {
        return report(error.what(), exit_bad_input);
    } catch (const EnvironmentError& error) {
        return report(error.what(), exit_environment);
    } catch (const std::bad_alloc&) {
        return report("not enough memory on this machine", exit_environment);
    } catch (const std::exception& error) {
        return report(error.what(), exit_short_of_target);
    }
}

}  // namespace tandem
