/// Which GPUs of a machine render.
#pragma once

#include <string>
#include <vector>

namespace tandem {

struct GpuChoice {
    int count = 1;               ///< this many, from the first on; 0: all
    std::vector<int> numbers{};  ///< if not empty, these instead, by CUDA's numbers
    friend bool operator==(const GpuChoice&, const GpuChoice&) = default;
};

/// Parses "all", a number of GPUs such as "2", or a list of their numbers such as "0,2". Throws InputError.
[[nodiscard]] GpuChoice parse_gpus(const std::string& text);

/// Parses a list of one or more numbers, or "all". Throws InputError.
[[nodiscard]] GpuChoice parse_gpu_list(const std::string& text);

/// The numbers of the chosen GPUs on a machine with GPUs of these names. Throws EnvironmentError, with the GPUs that
/// exist, if one does not.
[[nodiscard]] std::vector<int> chosen_gpus(const GpuChoice& choice, const std::vector<std::string>& names);

}  // namespace tandem
