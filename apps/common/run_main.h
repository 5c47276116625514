/// The frame around the main() of every program: exceptions become one line and an exit status.
#pragma once

#include <cstdio>
#include <exception>
#include <new>

#include "tandem/error/error.h"

namespace tandem {

/// Runs `main`, a function without arguments that returns the exit status. InputError gives 2; EnvironmentError, and
/// memory that ran out, 3; any other exception is a bug and gives 1. The message goes to standard error as
/// "program: message".
template <class Main>
int run_main(const char* program, Main&& main) {
    const auto say = [program](const char* message) { std::fprintf(stderr, "%s: %s\n", program, message); };
    try {
        return main();
    } catch (const InputError& error) {
        say(error.what());
        return 2;
    } catch (const EnvironmentError& error) {
        say(error.what());
        return 3;
    } catch (const std::bad_alloc&) {
        say("out of memory; ask for a smaller film or scene");
        return 3;
    } catch (const std::exception& error) {
        say(error.what());
        return 1;
    }
}

}  // namespace tandem
