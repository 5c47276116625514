/// The two exceptions that callers may have to handle. A bug is an assert; an expected miss is a std::optional. A
/// message says what is wrong, where (file, node, JSON path, flag) and what to do.
#pragma once

#include <stdexcept>

namespace tandem {

/// The input or the usage is wrong. Programs exit with status 2.
class InputError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The machine lacks something: a GPU, a driver, memory, a library. Programs exit with status 3.
class EnvironmentError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace tandem
