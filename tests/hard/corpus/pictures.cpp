#include "hard/corpus/pictures.h"

#include <fmt/format.h>

namespace tandem::hard {

RenderJob small_picture(const Subject& subject) {
    return {.width = 61, .height = 47, .samples = 3, .seed = 5, .frame = 0, .tier = subject.tier};
}

Film picture_of(Backend& backend, const PreparedScene& scene, const RenderJob& job, Score& score) {
    RenderResult result = backend.render(backend.load(scene, job.tier), job);
    score.nans += result.stats.counters.invalid_samples;
    score.seconds += result.stats.seconds.render;
    return std::move(result.film);
}

void compare_bits(const Film& film, const Film& right, const std::string& what, Score& score) {
    for (std::size_t i = 0; i < right.pixel_count(); ++i) {
        const Vec3d& a = film.sums()[i];
        const Vec3d& b = right.sums()[i];
        const bool equal = bits_of(a.x) == bits_of(b.x) && bits_of(a.y) == bits_of(b.y) && bits_of(a.z) == bits_of(b.z);
        score.decide(!equal, [&] {
            const auto width = static_cast<std::size_t>(right.width());
            return fmt::format("{}: pixel {}, {}: {:a} and {:a}", what, i % width, i / width, a.x, b.x);
        });
    }
}

}  // namespace tandem::hard
