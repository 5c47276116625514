#include "cuda/jit_link.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "cuda/cubin_facts.h"
#include "cuda/jit_libraries.h"
#include "tandem/base/error.h"

namespace tandem::cuda {

namespace {

/// nvJitLinkInputType.
enum class InputKind { ltoir = 3, fatbin = 4 };

/// A handle of one of the libraries, released at the end.
class Handle {
  public:
    explicit Handle(int (*destroy)(void**)) : destroy_(destroy) {}
    ~Handle() {
        if (value_ != nullptr) (void)destroy_(&value_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;

    [[nodiscard]] void* get() const { return value_; }
    [[nodiscard]] void** out() { return &value_; }

  private:
    int (*destroy_)(void**);
    void* value_ = nullptr;
};

/// A text that a library returns as a size and a zero-terminated string; empty if there is none.
template <class Size, class Text>
std::string text_of(void* handle, Size size, Text text) {
    std::size_t bytes = 0;
    if (handle == nullptr || size(handle, &bytes) != 0 || bytes == 0) return {};
    std::string result(bytes, '\0');
    if (text(handle, result.data()) != 0) return {};
    result.resize(std::string_view(result.c_str()).size());
    return result;
}

[[noreturn]] void fail(std::string_view doing, int code, const std::string& log) {
    throw std::runtime_error(fmt::format("specialising a kernel failed while {} (code {}): {}", doing, code,
                                         log.empty() ? "the library gave no reason" : log));
}

const JitLibraries& available_libraries() {
    const JitLibraries& libraries = jit_libraries();
    if (!libraries.problem.empty()) throw EnvironmentError(libraries.problem);
    return libraries;
}

/// Compiles LTO-IR that defines the facts. nvJitLink does not fold constants that come as PTX.
std::vector<char> compile_facts(const JitCompiler& compiler, const JitInput& input) {
    const std::string declaration =
        fmt::format("__device__ const unsigned int {}[{}]", input.facts_name, input.facts.size());
    const std::string source =
        fmt::format("extern \"C\" {{ extern {0}; {0} = {{{1}}}; }}\n", declaration, fmt::join(input.facts, ", "));
    const std::string architecture = fmt::format("-arch=compute_{}", input.architecture);
    const char* const options[] = {"-dlto", "-rdc=true", "-minimal", architecture.c_str()};

    Handle program(compiler.destroy);
    const auto check = [&](int code) {
        if (code != 0) fail("compiling its facts", code, text_of(program.get(), compiler.log_size, compiler.log));
    };
    check(compiler.create(program.out(), source.c_str(), "facts.cu", 0, nullptr, nullptr));
    check(compiler.compile(program.get(), static_cast<int>(std::size(options)), options));
    std::size_t bytes = 0;
    check(compiler.ltoir_size(program.get(), &bytes));
    std::vector<char> module(bytes);
    check(compiler.ltoir(program.get(), module.data()));
    return module;
}

}  // namespace

const std::string& why_jit_unavailable() { return jit_libraries().problem; }

std::string jit_version() {
    const JitLibraries& libraries = available_libraries();
    return fmt::format("nvJitLink {}, NVRTC {}", to_string(libraries.linker->version),
                       to_string(libraries.compiler->version));
}

std::vector<std::string> link_options(const JitInput& input) {
    std::vector<std::string> options = {"-lto", fmt::format("-arch=sm_{}", input.architecture),
                                        fmt::format("-kernels-used={}", input.kernel)};
    const int fast = input.tier == Tier::fast ? 1 : 0;
    options.push_back(fmt::format("-fma={}", fast));
    options.push_back(fmt::format("-ftz={}", fast));
    options.push_back(fmt::format("-prec-div={}", 1 - fast));
    options.push_back(fmt::format("-prec-sqrt={}", 1 - fast));
    if (input.registers > 0) options.push_back(fmt::format("-maxrregcount={}", input.registers));
    options.emplace_back("-split-compile=0");  // compile functions in parallel, on all processors
    return options;
}

std::vector<std::byte> link(const JitInput& input) {
    const JitLibraries& libraries = available_libraries();
    const JitLinker& linker = *libraries.linker;
    const std::vector<char> facts = compile_facts(*libraries.compiler, input);

    const std::vector<std::string> options = link_options(input);
    std::vector<const char*> arguments(options.size());
    std::transform(options.begin(), options.end(), arguments.begin(),
                   [](const auto& option) { return option.c_str(); });

    Handle handle(linker.destroy);
    const auto log = [&] { return text_of(handle.get(), linker.error_log_size, linker.error_log); };
    const auto check = [&](int code, const char* doing) {
        if (code != 0) fail(doing, code, log());
    };
    check(linker.create(handle.out(), static_cast<std::uint32_t>(arguments.size()), arguments.data()),
          fmt::format("starting nvJitLink with {}", fmt::join(options, " ")).c_str());
    check(linker.add(handle.get(), static_cast<int>(InputKind::fatbin), input.code.data(), input.code.size(), "kernel"),
          "reading its LTO-IR");
    check(linker.add(handle.get(), static_cast<int>(InputKind::ltoir), facts.data(), facts.size(), "facts"),
          "reading its facts");
    check(linker.complete(handle.get()), "linking");

    // some errors still give a result: a constant in another memory space ...
    if (!log().empty()) fail("linking", 0, log());

    std::size_t bytes = 0;
    check(linker.cubin_size(handle.get(), &bytes), "fetching the result");
    std::vector<std::byte> cubin(bytes);
    check(linker.cubin(handle.get(), cubin.data()), "fetching the result");
    // ... or an undefined one, which becomes zero; the linker does not always report that
    const bool is_zero = std::all_of(input.facts.begin(), input.facts.end(), [](auto fact) { return fact == 0; });
    if (const auto name = variable_of_zeros(cubin); !name.empty() && !is_zero) {
        fail("linking", 0, fmt::format("nothing defines '{}'", name));
    }
    if (!cubin_facts(cubin, input.kernel)) fail("linking", 0, fmt::format("there is no kernel '{}'", input.kernel));
    return cubin;
}

}  // namespace tandem::cuda
