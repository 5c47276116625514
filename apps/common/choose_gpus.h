/// The option --gpus, and what programs say when a GPU fails and others go on.
#pragma once

#include <cstdio>
#include <string>

#include "tandem/base/error.h"
#include "tandem/render/backend.h"

namespace tandem {

/// `gpus`: the option as typed; empty if it was not given. Throws InputError that names the option.
inline void choose_gpus(BackendOptions& options, const std::string& gpus, const std::string& program) {
    try {
        if (!gpus.empty()) options.gpus = parse_gpus(gpus);
    } catch (const InputError& error) {
        throw InputError("--gpus: " + std::string(error.what()));
    }
    options.report = [program](const std::string& sentence) {
        std::fprintf(stderr, "%s: %s\n", program.c_str(), sentence.c_str());
    };
}

}  // namespace tandem
