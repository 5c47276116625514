#include "tandem/render/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/tone_curve.h"
#include "tandem/math/fp_environment.h"
#include "tandem/render/adaptive_frame.h"
#include "tandem/render/frame_metadata.h"
#include "tandem/render/motion_blur.h"
#include "tandem/render/tiled_film.h"

namespace tandem {

namespace {

constexpr int tile_edge = 32;

/// Distinct tiles in random order. The same seed gives the same ones on every machine.
std::vector<std::size_t> some_of(std::size_t count, const VerifyOptions& how) {
    std::vector<std::size_t> tiles(count);
    std::iota(tiles.begin(), tiles.end(), std::size_t{0});
    std::mt19937_64 random(how.seed);
    const std::size_t wanted = std::min(std::max<std::size_t>(how.tiles, 1), count);
    for (std::size_t i = 0; i < wanted; ++i) {
        // the remainder favours small numbers by less than 2^-32, for fewer than 2^32 tiles
        std::swap(tiles[i], tiles[i + static_cast<std::size_t>(random() % (count - i))]);
    }
    tiles.resize(wanted);
    return tiles;
}

FloatImage cut(const FloatImage& image, const FilmWindow& window) {
    FloatImage part{window.width, window.height, {}};
    for (int y = window.top; y < window.top + window.height; ++y) {
        const auto row = image.pixels.begin() + static_cast<std::ptrdiff_t>(y) * image.width + window.left;
        part.pixels.insert(part.pixels.end(), row, row + window.width);
    }
    return part;
}

/// The number of pixels that differ; the values of a pixel have `size` bytes.
std::size_t differing(const void* a, const void* b, std::size_t pixels, std::size_t size) {
    const auto* const first = static_cast<const std::byte*>(a);
    const auto* const second = static_cast<const std::byte*>(b);
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixels; ++i) count += std::memcmp(first + i * size, second + i * size, size) != 0;
    return count;
}

std::size_t differing(const FloatImage& drawn, const FloatImage& file, const DecodedImage& image) {
    if (holds_floats(image.format)) {
        return differing(drawn.pixels.data(), file.pixels.data(), pixel_count(drawn), sizeof(Vec3f));
    }
    const ByteImage a = tone_map(drawn, image.display).image, b = tone_map(file, image.display).image;
    return differing(a.values.data(), b.values.data(), pixel_count(a), 3);
}

/// The metadata, if the image can be verified by the backend.
const ImageMetadata& checked_metadata(const Backend& backend, const DecodedImage& image) {
    if (!image.metadata || image.metadata->scene_hash.empty()) {
        throw InputError(
            "the image has no metadata of tandem-render: it was written by another program, or changed by one (a .pfm "
            "needs its own .pfm.txt beside it)");
    }
    const ImageMetadata& metadata = *image.metadata;
    if (!metadata.denoised.empty()) {
        throw InputError(fmt::format(
            "the image was denoised by {} after it was rendered, so its pixels are not those that a backend draws; "
            "render it without --denoise to have an image that can be verified",
            metadata.denoised));
    }
    if (metadata.width != image.image.width || metadata.height != image.image.height) {
        throw InputError(fmt::format("the image has {} x {} pixels, but its metadata say {} x {}: it was changed",
                                     image.image.width, image.image.height, metadata.width, metadata.height));
    }
    if (parse_tier(metadata.tier) == Tier::fast) {
        throw InputError(
            "the image is of the tier fast, which guarantees no bits; only images of the tiers strict and precise can "
            "be verified");
    }
    if (!backend.capabilities().exact && metadata.backend != backend.name()) {
        throw InputError(
            fmt::format("'{}' does not render the bits of '{}', which rendered the image; use --backend {}",
                        backend.name(), metadata.backend, metadata.backend));
    }
    return metadata;
}

/// Renders windows of the frame.
class WindowRender {
  public:
    WindowRender(Backend& backend, const Scene& scene, const FramePlan& plan, std::string& hash)
        : backend_(backend), scene_(scene), plan_(plan) {
        if (is_blurred(plan)) {
            hash = frame_hash(scene, plan);
            return;
        }
        const PreparedScene prepared = prepare(scene, plan.instants.front().prepare);
        FrameHash own(plan);
        own.add(prepared);
        hash = own.get();
        resident_ = backend.load(prepared, plan.instants.front().job.tier);
    }

    /// A window with all samples of the frame.
    [[nodiscard]] Film render(const FilmWindow& window) {
        FramePlan part = plan_;
        for (FrameInstant& instant : part.instants) instant.job.window = window;
        if (!resident_) return render_frame(backend_, scene_, part).result.film;
        return backend_.render(resident_, part.instants.front().job).film;
    }

    /// A window with fewer, in the parts of render_to_target(). There is no motion blur.
    [[nodiscard]] Film render(const FilmWindow& window, int samples) {
        RenderJob job = plan_.instants.front().job;
        const int most = job.samples;
        job.window = window;
        Film film;
        for (int begin = 0; begin < samples;) {
            const int end = next_part_end(begin, most);
            job.first_sample = begin;
            job.samples = end - begin;
            Film part = backend_.render(resident_, job).film;
            if (begin == 0) {
                film = std::move(part);
            } else {
                film.add(part);
            }
            begin = end;
        }
        return film;
    }

  private:
    Backend& backend_;
    const Scene& scene_;
    const FramePlan& plan_;
    std::shared_ptr<ResidentScene> resident_;  ///< null with motion blur
};

}  // namespace

double Verdict::largest_unseen_share() const {
    return drawn < tiles ? std::min(3 / static_cast<double>(drawn), 1.0) : 0;
}

Verdict verify_image(Backend& backend, const Scene& scene, const PrepareOptions& options, const DecodedImage& image,
                     const VerifyOptions& how) {
    const DefaultFpEnvironment guard;
    const ImageMetadata& metadata = checked_metadata(backend, image);
    const RenderJob job = job_of(metadata);
    const FramePlan plan = plan_frame(scene, options, job);
    TileSamples samples{{job.width, job.height, tile_edge}, {}};
    const bool has_parts = !metadata.tile_samples.empty();
    if (has_parts) {
        check_still(plan);
        samples = parse_tile_samples(metadata.tile_samples, job.width, job.height);
    }

    std::string hash;
    WindowRender windows(backend, scene, plan, hash);
    if (hash != metadata.scene_hash) {
        throw InputError(
            fmt::format("the scene is not that of the image: its hash is {}, but the image says {}. Give the file, the "
                        "camera and the options that the image was rendered with",
                        hash, metadata.scene_hash));
    }
    TiledFilm film(samples.grid, {});
    Verdict verdict;
    verdict.tiles = samples.grid.count();
    verdict.pixels = pixel_count(image.image);
    for (const std::size_t index : some_of(verdict.tiles, how)) {
        const FilmWindow window = samples.grid.tile(index);
        const Film part = has_parts ? windows.render(window, samples.samples[index]) : windows.render(window);
        const std::size_t bad = differing(film_to_image(part), cut(image.image, window), image);
        if (bad > 0) verdict.differing.push_back(window);
        verdict.differing_pixels += bad;
        verdict.drawn_pixels += pixel_count(window);
        ++verdict.drawn;
        film.add(index, part);
    }
    verdict.has_film = verdict.drawn == verdict.tiles;
    verdict.film_matches = verdict.has_film && film_hash(film.whole()) == metadata.film_sha256;
    return verdict;
}

}  // namespace tandem
