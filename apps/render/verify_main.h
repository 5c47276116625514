/// The command line of tandem-render verify.
#pragma once

namespace tandem {

/// `argv[0]` is the program, argv[1] "verify". Returns the exit status; throws as run_verify() does.
[[nodiscard]] int verify(int argc, char** argv);

}  // namespace tandem
