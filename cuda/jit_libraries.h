/// The CUDA libraries that specialise kernels: nvJitLink, which links LTO-IR, and NVRTC, which compiles the constants.
/// They are opened at run time, so that programs start without them. Their functions are declared here by hand, so that
/// Tandem can be built without their headers (nvJitLink.h, nvrtc.h: plain C, results are enums, handles are pointers).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tandem::cuda {

struct ToolkitVersion {
    unsigned int major = 0;
    unsigned int minor = 0;
    friend bool operator==(const ToolkitVersion&, const ToolkitVersion&) = default;
};
[[nodiscard]] std::string to_string(const ToolkitVersion& version);

/// nvJitLink. 0 is success.
struct JitLinker {
    ToolkitVersion version;
    int (*create)(void** handle, std::uint32_t count, const char* const* options);
    int (*destroy)(void** handle);
    int (*add)(void* handle, int kind, const void* data, std::size_t bytes, const char* name);
    int (*complete)(void* handle);
    int (*cubin_size)(void* handle, std::size_t* bytes);
    int (*cubin)(void* handle, void* bytes);
    int (*error_log_size)(void* handle, std::size_t* bytes);
    int (*error_log)(void* handle, char* text);
};

/// NVRTC. 0 is success.
struct JitCompiler {
    ToolkitVersion version;
    int (*create)(void** program, const char* source, const char* name, int headers, const char* const* header_sources,
                  const char* const* header_names);
    int (*destroy)(void** program);
    int (*compile)(void* program, int count, const char* const* options);
    int (*ltoir_size)(void* program, std::size_t* bytes);
    int (*ltoir)(void* program, char* bytes);
    int (*log_size)(void* program, std::size_t* bytes);
    int (*log)(void* program, char* text);
};

/// Both libraries, or why they are not available. They stay open until the program ends.
struct JitLibraries {
    std::unique_ptr<const JitLinker> linker;
    std::unique_ptr<const JitCompiler> compiler;
    std::string problem;  ///< what is missing, where it was searched, and what to do; empty if both are there
};

/// The folders to search: only those in TANDEM_CUDA_LIBRARIES (separated by colons) if that is set; else the loader's
/// path, written as "", the toolkit that built Tandem, and /usr/local/cuda.
[[nodiscard]] std::vector<std::string> jit_folders();

/// The first of each library from the CUDA release that built Tandem's kernels, or a later one of the same major
/// version: an older linker cannot read the LTO-IR. The linker must not be older than the compiler.
[[nodiscard]] JitLibraries open_jit_libraries(const std::vector<std::string>& folders);

/// open_jit_libraries(jit_folders()), once.
[[nodiscard]] const JitLibraries& jit_libraries();

}  // namespace tandem::cuda
