// Shared by the builds of the naive renderer: the animation, the distribution of rows to threads, the text file.
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <numbers>
#include <thread>
#include <vector>

#include "naive_renderer.h"
#include "tandem/base/error.h"

namespace tandem::bench {

NaiveFrame naive_frame(int number) {
    const double angle = 2 * std::numbers::pi * (number % 120) / 120;
    const auto sine = static_cast<float>(std::sin(angle));
    const auto cosine = static_cast<float>(std::cos(angle));
    return {{2 * cosine, 2, -3 + 2 * sine}, {0.6F, 0.8F * sine, -2.2F}};
}

void naive_render(const NaiveBuild& build, const NaiveJob& job, int threads, float* rgb) {
    const NaiveFrame frame = naive_frame(job.frame);
    std::atomic<int> next_row = 0;
    const auto work = [&] {
        for (int y = next_row++; y < job.height; y = next_row++) {
            build.render_row(job, frame, y,
                             rgb + std::size_t{3} * static_cast<std::size_t>(job.width) * static_cast<std::size_t>(y));
        }
    };
    std::vector<std::jthread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back(work);
    work();
}

void naive_write_ppm(const std::string& path, int width, int height, const float* rgb) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "w"), std::fclose);
    if (!file) throw EnvironmentError("cannot write " + path + ": " + std::strerror(errno));
    std::fprintf(file.get(), "P3\n%d %d\n255\n", width, height);
    const auto level = [](float value) {
        return static_cast<int>(255.99F * (value < 0 ? 0.0F : value > 1 ? 1.0F : value));
    };
    for (int i = 0; i < width * height; ++i, rgb += 3) {
        std::fprintf(file.get(), "%d %d %d\n", level(rgb[0]), level(rgb[1]), level(rgb[2]));
    }
    if (std::fflush(file.get()) != 0) throw EnvironmentError("cannot write " + path + ": " + std::strerror(errno));
}

}  // namespace tandem::bench
