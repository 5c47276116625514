#include "tandem/images/denoiser.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cassert>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <vector>

#include "tandem/base/error.h"
#include "tandem/film/plane_image.h"

namespace tandem {

// The part of its documented C interface that is used, in the names and values of versions 1.4 to 2.x.
namespace oidn {

using Handle = void*;

struct Functions {
    Handle (*new_device)(int type) = nullptr;
    void (*commit_device)(Handle) = nullptr;
    void (*release_device)(Handle) = nullptr;
    int (*get_error)(Handle, const char** message) = nullptr;
    int (*get_device_int)(Handle, const char* name) = nullptr;
    void (*set_device_int)(Handle, const char* name, int) = nullptr;
    void (*set_device_bool)(Handle, const char* name, bool) = nullptr;
    Handle (*new_filter)(Handle device, const char* type) = nullptr;
    void (*set_image)(Handle filter, const char* name, void* pixels, int format, std::size_t width, std::size_t height,
                      std::size_t byte_offset, std::size_t pixel_stride, std::size_t row_stride) = nullptr;
    void (*set_filter_bool)(Handle filter, const char* name, bool) = nullptr;
    void (*commit_filter)(Handle) = nullptr;
    void (*execute_filter)(Handle) = nullptr;
    void (*release_filter)(Handle) = nullptr;
};

struct LibraryCloser {
    void operator()(void* library) const { ::dlclose(library); }
};
using Library = std::unique_ptr<void, LibraryCloser>;

inline constexpr int device_type_cpu = 1;
inline constexpr int format_float3 = 3;
inline constexpr int error_none = 0;

}  // namespace oidn

namespace {

constexpr std::array library_names = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1", "libOpenImageDenoise.so"};
constexpr const char* advice =
    "Install Open Image Denoise, and name its libOpenImageDenoise.so.2 with --denoiser FILE, or its folder in "
    "LD_LIBRARY_PATH (docs/denoising.md)";

oidn::Library open_library(const std::string& file) {
    if (!file.empty()) {
        oidn::Library library(::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL));
        if (library) return library;
        const char* reason = ::dlerror();
        throw EnvironmentError(fmt::format("cannot open the denoiser '{}': {}. {}", file,
                                           reason == nullptr ? "no reason given" : reason, advice));
    }
    std::string names, reasons;
    for (const char* name : library_names) {
        oidn::Library library(::dlopen(name, RTLD_NOW | RTLD_LOCAL));
        if (library) return library;
        const char* reason = ::dlerror();
        names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
        // the reason starts with this name if the library is not found, else with the name of a missing dependency
        if (reason != nullptr && !std::string_view(reason).starts_with(name)) reasons += fmt::format("; {}", reason);
    }
    const char* folders = std::getenv("LD_LIBRARY_PATH");
    throw EnvironmentError(fmt::format(
        "cannot load Open Image Denoise: tried {} in the folders of LD_LIBRARY_PATH ({}) and of the system's loader{}. "
        "{}",
        names, folders == nullptr || *folders == '\0' ? "not set" : folders, reasons, advice));
}

/// `older`: the function's name in versions before 2.0, if it had another.
template <class Function>
void find(void* library, Function& function, const char* name, const char* older = nullptr) {
    void* found = ::dlsym(library, name);
    if (found == nullptr && older != nullptr) found = ::dlsym(library, older);
    if (found == nullptr) {
        throw EnvironmentError(fmt::format(
            "the denoiser's library has no function {}: it is not Open Image Denoise, or older than 1.4. {}", name,
            advice));
    }
    function = reinterpret_cast<Function>(found);
}

oidn::Functions functions_of(void* library) {
    oidn::Functions f;
    find(library, f.new_device, "oidnNewDevice");
    find(library, f.commit_device, "oidnCommitDevice");
    find(library, f.release_device, "oidnReleaseDevice");
    find(library, f.get_error, "oidnGetDeviceError");
    find(library, f.get_device_int, "oidnGetDeviceInt", "oidnGetDevice1i");
    find(library, f.set_device_int, "oidnSetDeviceInt", "oidnSetDevice1i");
    find(library, f.set_device_bool, "oidnSetDeviceBool", "oidnSetDevice1b");
    find(library, f.new_filter, "oidnNewFilter");
    find(library, f.set_image, "oidnSetSharedFilterImage");
    find(library, f.set_filter_bool, "oidnSetFilterBool", "oidnSetFilter1b");
    find(library, f.commit_filter, "oidnCommitFilter");
    find(library, f.execute_filter, "oidnExecuteFilter");
    find(library, f.release_filter, "oidnReleaseFilter");
    return f;
}

std::vector<float> plane_of(const std::vector<PlaneImage>& planes, FilmPlane wanted) {
    for (const PlaneImage& plane : planes) {
        if (plane.plane == wanted) return plane.values;
    }
    assert(false);
    return {};
}

}  // namespace

struct Denoiser::State {
    explicit State(const std::string& file) : library(open_library(file)), call(functions_of(library.get())) {}
    ~State() {
        if (device != nullptr) call.release_device(device);
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    /// Throws the library's error since the last call, if there is one. With a null device, throws in any case.
    void check(const char* what) const {
        const char* message = nullptr;
        if (call.get_error(device, &message) == oidn::error_none && device != nullptr) return;
        throw EnvironmentError(
            fmt::format("Open Image Denoise cannot {}: {}", what, message == nullptr ? "it gives no reason" : message));
    }

    oidn::Library library;
    oidn::Functions call;
    oidn::Handle device = nullptr;
    std::string name;
    std::mutex one_at_a_time;
};

Denoiser::Denoiser(const std::string& library, int threads) : state_(std::make_unique<State>(library)) {
    const oidn::Functions& call = state_->call;
    state_->device = call.new_device(oidn::device_type_cpu);
    state_->check("make a CPU device");
    if (threads > 0) call.set_device_int(state_->device, "numThreads", threads);
    call.set_device_bool(state_->device, "setAffinity", false);  // the threads of a renderer need the cores too
    call.commit_device(state_->device);
    state_->check("start its CPU device");
    const int version = call.get_device_int(state_->device, "version");
    state_->name = fmt::format("Open Image Denoise {}.{}.{}", version / 10000, version / 100 % 100, version % 100);
}

Denoiser::~Denoiser() = default;

const std::string& Denoiser::name() const { return state_->name; }

FloatImage Denoiser::denoise(const Film& film) const {
    FloatImage colour = film_to_image(film);
    const std::vector<PlaneImage> planes = plane_images(film);
    std::vector<float> albedo = plane_of(planes, FilmPlane::albedo);
    std::vector<float> normal = plane_of(planes, FilmPlane::normal);
    FloatImage result{colour.width, colour.height, std::vector<Vec3f>(pixel_count(colour))};

    const std::lock_guard guard(state_->one_at_a_time);
    const oidn::Functions& call = state_->call;
    const std::unique_ptr<void, void (*)(oidn::Handle)> filter(call.new_filter(state_->device, "RT"),
                                                               call.release_filter);
    state_->check("make its filter");
    const auto set = [&](const char* name, void* pixels) {
        call.set_image(filter.get(), name, pixels, oidn::format_float3, static_cast<std::size_t>(colour.width),
                       static_cast<std::size_t>(colour.height), 0, 0, 0);
    };
    set("color", colour.pixels.data());
    set("albedo", albedo.data());
    set("normal", normal.data());
    set("output", result.pixels.data());
    call.set_filter_bool(filter.get(), "hdr", true);
    call.commit_filter(filter.get());
    call.execute_filter(filter.get());
    state_->check("denoise the image");
    return result;
}

}  // namespace tandem
