// A library with the functions of Open Image Denoise that Tandem calls. It writes its calls to the file that
// STUB_DENOISER_LOG names, and its filter gives half of the colour plus the albedo. STUB_DENOISER_FAILS names the call
// that fails: device, commit, filter or execute. Compiled with STUB_INCOMPLETE it lacks a function.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

const char* error = nullptr;

void log(const std::string& line) {
    const char* file = std::getenv("STUB_DENOISER_LOG");
    if (file == nullptr) return;
    if (std::FILE* out = std::fopen(file, "a")) {
        std::fprintf(out, "%s\n", line.c_str());
        std::fclose(out);
    }
}

bool fails(const char* what) {
    const char* named = std::getenv("STUB_DENOISER_FAILS");
    const bool it = named != nullptr && std::strcmp(named, what) == 0;
    if (it) error = "the stub was told to fail";
    return it;
}

struct Image {
    float* values = nullptr;
    std::size_t width = 0, height = 0;
};

struct Filter {
    Image color, albedo, normal, output;
    bool hdr = false, committed = false;
};

int device = 0;

}  // namespace

extern "C" {

void* oidnNewDevice(int type) {
    log("device " + std::to_string(type));
    return fails("device") ? nullptr : &device;
}
void oidnCommitDevice(void*) {
    if (!fails("commit")) log("commit device");
}
void oidnReleaseDevice(void*) { log("release device"); }
int oidnGetDeviceError(void*, const char** message) {
    *message = error;
    const int code = error == nullptr ? 0 : 1;
    error = nullptr;
    return code;
}
int oidnGetDeviceInt(void*, const char* name) { return std::strcmp(name, "version") == 0 ? 20304 : -1; }
void oidnSetDeviceInt(void*, const char* name, int value) { log(std::string(name) + " " + std::to_string(value)); }
void oidnSetDeviceBool(void*, const char* name, bool value) { log(std::string(name) + " " + std::to_string(value)); }
void* oidnNewFilter(void*, const char* type) {
    log(std::string("filter ") + type);
    return fails("filter") ? nullptr : new Filter;
}
void oidnSetSharedFilterImage(void* filter, const char* name, void* pixels, int format, std::size_t width,
                              std::size_t height, std::size_t offset, std::size_t pixel, std::size_t row) {
    auto& f = *static_cast<Filter*>(filter);
    Image& image = std::strcmp(name, "color") == 0    ? f.color
                   : std::strcmp(name, "albedo") == 0 ? f.albedo
                   : std::strcmp(name, "normal") == 0 ? f.normal
                                                      : f.output;
    image = {static_cast<float*>(pixels), width, height};
    log(std::string("image ") + name + " " + std::to_string(format) + " " + std::to_string(width) + "x" +
        std::to_string(height) + " " + std::to_string(offset + pixel + row));
}
void oidnSetFilterBool(void* filter, const char* name, bool value) {
    if (std::strcmp(name, "hdr") == 0) static_cast<Filter*>(filter)->hdr = value;
    log(std::string(name) + " " + std::to_string(value));
}
void oidnCommitFilter(void* filter) { static_cast<Filter*>(filter)->committed = true; }
#ifndef STUB_INCOMPLETE
void oidnExecuteFilter(void* filter) {
    const auto& f = *static_cast<Filter*>(filter);
    if (fails("execute") || !f.committed || !f.hdr || f.normal.values == nullptr) {
        error = "the stub was told to fail";
        return;
    }
    for (std::size_t i = 0; i < 3 * f.output.width * f.output.height; ++i) {
        f.output.values[i] = f.color.values[i] / 2 + f.albedo.values[i];
    }
    log("execute");
}
#endif
void oidnReleaseFilter(void* filter) {
    log("release filter");
    delete static_cast<Filter*>(filter);
}

}  // extern "C"
