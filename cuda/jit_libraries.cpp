#include "cuda/jit_libraries.h"

#include <cuda_runtime_api.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace tandem::cuda {

namespace {

constexpr ToolkitVersion built_with = {CUDART_VERSION / 1000, CUDART_VERSION % 1000 / 10};

/// Whether a version is at least `oldest`, with the same major version.
bool serves(const ToolkitVersion& version, const ToolkitVersion& oldest) {
    return version.major == oldest.major && version.minor >= oldest.minor;
}

/// Looks up functions by name, and remembers a missing one.
class Symbols {
  public:
    explicit Symbols(void* library) : library_(library) {}
    template <class Function>
    void find(const char* name, Function*& function) {
        function = reinterpret_cast<Function*>(::dlsym(library_, name));
        if (function == nullptr) missing_ = name;
    }
    /// Empty if every function was there.
    [[nodiscard]] const std::string& missing() const { return missing_; }

  private:
    void* library_;
    std::string missing_;
};

constexpr const char* stem(const JitLinker&) { return "libnvJitLink.so"; }
constexpr const char* stem(const JitCompiler&) { return "libnvrtc.so"; }

/// What the library lacks; empty if it is complete.
std::string load(void* handle, JitLinker& linker) {
    Symbols symbols(handle);
    int (*version)(unsigned int* major, unsigned int* minor) = nullptr;
    symbols.find("nvJitLinkVersion", version);
    symbols.find("nvJitLinkCreate", linker.create);
    symbols.find("nvJitLinkDestroy", linker.destroy);
    symbols.find("nvJitLinkAddData", linker.add);
    symbols.find("nvJitLinkComplete", linker.complete);
    symbols.find("nvJitLinkGetLinkedCubinSize", linker.cubin_size);
    symbols.find("nvJitLinkGetLinkedCubin", linker.cubin);
    symbols.find("nvJitLinkGetErrorLogSize", linker.error_log_size);
    symbols.find("nvJitLinkGetErrorLog", linker.error_log);
    if (!symbols.missing().empty()) return symbols.missing();
    return version(&linker.version.major, &linker.version.minor) == 0 ? "" : "a version";
}

std::string load(void* handle, JitCompiler& compiler) {
    Symbols symbols(handle);
    int (*version)(int* major, int* minor) = nullptr;
    symbols.find("nvrtcVersion", version);
    symbols.find("nvrtcCreateProgram", compiler.create);
    symbols.find("nvrtcDestroyProgram", compiler.destroy);
    symbols.find("nvrtcCompileProgram", compiler.compile);
    symbols.find("nvrtcGetLTOIRSize", compiler.ltoir_size);
    symbols.find("nvrtcGetLTOIR", compiler.ltoir);
    symbols.find("nvrtcGetProgramLogSize", compiler.log_size);
    symbols.find("nvrtcGetProgramLog", compiler.log);
    if (!symbols.missing().empty()) return symbols.missing();
    int major = 0, minor = 0;
    if (version(&major, &minor) != 0) return "a version";
    compiler.version = {static_cast<unsigned int>(major), static_cast<unsigned int>(minor)};
    return "";
}

/// The first library in the folders that `fits`; null if there is none, with the reasons added to `problems`.
template <class Library, class Fits>
std::unique_ptr<const Library> open_first(const std::vector<std::string>& folders, std::vector<std::string>& problems,
                                          Fits fits) {
    const std::string name = fmt::format("{}.{}", stem(Library{}), built_with.major);
    for (const std::string& folder : folders) {
        const std::string path = folder.empty() ? name : fmt::format("{}/{}", folder, name);
        void* handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (handle == nullptr) {
            const char* why = ::dlerror();
            problems.emplace_back(why != nullptr ? why : path + " cannot be opened");
            continue;
        }
        auto library = std::make_unique<Library>();
        const std::string missing = load(handle, *library);
        if (missing.empty() && fits(library->version)) return library;
        problems.push_back(!missing.empty() ? fmt::format("{} lacks {}", path, missing)
                                            : fmt::format("{} is of CUDA {}", path, to_string(library->version)));
        ::dlclose(handle);
    }
    return nullptr;
}

}  // namespace

std::string to_string(const ToolkitVersion& version) { return fmt::format("{}.{}", version.major, version.minor); }

std::vector<std::string> jit_folders() {
    const char* named = std::getenv("TANDEM_CUDA_LIBRARIES");
    if (named == nullptr) return {"", TANDEM_CUDA_LIBRARY_DIR, "/usr/local/cuda/lib64"};
    std::vector<std::string> folders;
    std::string_view rest = named;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(':'), rest.size());
        if (end > 0) folders.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return folders;
}

JitLibraries open_jit_libraries(const std::vector<std::string>& folders) {
    JitLibraries libraries;
    std::vector<std::string> problems;
    libraries.linker = open_first<JitLinker>(folders, problems,
                                             [](const ToolkitVersion& version) { return serves(version, built_with); });
    if (libraries.linker != nullptr) {
        problems.clear();
        libraries.compiler = open_first<JitCompiler>(folders, problems, [&](const ToolkitVersion& version) {
            return serves(version, built_with) && serves(libraries.linker->version, version);
        });
    }
    if (libraries.compiler == nullptr) {
        libraries.problem = fmt::format(
            "kernels cannot be specialised: no {} of CUDA {} or a later {}.x was found{}{}; install the CUDA toolkit's "
            "runtime libraries, or set TANDEM_CUDA_LIBRARIES to their folder",
            libraries.linker == nullptr ? "nvJitLink" : "NVRTC", to_string(built_with), built_with.major,
            problems.empty() ? "" : ": ", fmt::join(problems, "; "));
    }
    return libraries;
}

const JitLibraries& jit_libraries() {
    static const JitLibraries libraries = open_jit_libraries(jit_folders());
    return libraries;
}

}  // namespace tandem::cuda
