/// Messages of exceptions, for tests.
#pragma once

#include <string>

namespace tandem::test {

/// The message of the `Error` that `action` throws; empty if it throws none. Other exceptions are passed on.
template <class Error, class Action>
std::string thrown_message(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

}  // namespace tandem::test
