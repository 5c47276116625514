/// Errors that a test expects.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tandem/base/error.h"

namespace tandem::test {

/// The message of the InputError that `call` throws; fails the test if it throws none.
template <class Call>
std::string input_error(Call call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "no InputError";
    return {};
}

/// For EXPECT_TRUE: prints the text if `part` is not in it.
inline testing::AssertionResult contains(const std::string& text, const std::string& part) {
    if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "\"" << text << "\" does not contain \"" << part << "\"";
}

}  // namespace tandem::test
