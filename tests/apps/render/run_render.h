/// Runs tandem-render, for tests.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace tandem::test {

struct Finished {
    int status = -1;
    std::string printed;  ///< standard output and standard error
};

inline Finished tandem_render(const std::string& arguments) {
    const std::string command = std::string("'") + TANDEM_RENDER_PROGRAM + "' " + arguments + " 2>&1";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    Finished run;
    std::array<char, 4096> buffer;
    while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
        run.printed.append(buffer.data(), size);
    }
    const int status = ::pclose(pipe);
    run.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return run;
}

}  // namespace tandem::test
