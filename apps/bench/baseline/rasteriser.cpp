#include "baseline/rasteriser.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "tandem/base/error.h"
#include "tandem/kernel/lights/punctual_light.h"

namespace tandem::bench {

namespace {

constexpr std::uint32_t nothing = 0xFFFFFFFFU;
constexpr int band_rows = 16;
using LightEffects = EffectSet<rasterised_effects.bits()>;

/// What a pass has found at a pixel.
struct Nearest {
    double nearness = -HUGE_VAL;
    std::uint32_t part = nothing;  ///< index of a ScreenTriangle
};

/// Weights of the corners on the screen, which add up to 1.
Vec3d screen_weights(const ScreenTriangle& triangle, const EdgeValues& edges) {
    const double scale = 1 / static_cast<double>(triangle.area);
    return {static_cast<double>(edges.of[0]) * scale, static_cast<double>(edges.of[1]) * scale,
            static_cast<double>(edges.of[2]) * scale};
}

/// The triangles on the screen, and which of them reach into each band of rows.
class Screen {
  public:
    Screen(const RasterScene& scene, int width, int height) : width_(width), height_(height) {
        const Projection projection(scene, width, height);
        for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
            projection.add(scene.triangles[i], static_cast<std::uint32_t>(i), parts_);
        }
        of_band_.resize(static_cast<std::size_t>((height + band_rows - 1) / band_rows));
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            const ScreenCorner* c = parts_[i].corners;
            const auto band_of = [&](std::int64_t y) {
                return std::clamp(static_cast<int>(y / (band_rows * subpixels)), 0, bands() - 1);
            };
            // the samples of a row are up to a pixel below its top
            const int last = band_of(std::max({c[0].y, c[1].y, c[2].y}));
            for (int band = band_of(std::min({c[0].y, c[1].y, c[2].y}) - subpixels); band <= last; ++band) {
                of_band_[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(i));
            }
        }
    }

    [[nodiscard]] int bands() const { return static_cast<int>(of_band_.size()); }
    [[nodiscard]] const ScreenTriangle& part(std::uint32_t i) const { return parts_[i]; }
    [[nodiscard]] PixelRange range_of(int band) const {
        return {0, width_, band * band_rows, std::min((band + 1) * band_rows, height_)};
    }

    /// Fills the z-buffer of a band. Of equally near triangles the first counts.
    void draw(int band, const SamplePlace& place, std::vector<Nearest>& buffer) const {
        const PixelRange range = range_of(band);
        buffer.assign(static_cast<std::size_t>(width_) * band_rows, {});
        for (const std::uint32_t number : of_band_[static_cast<std::size_t>(band)]) {
            const ScreenTriangle& triangle = parts_[number];
            fill(triangle, place, range, [&](int x, int y, const EdgeValues& edges) {
                const Vec3d at = screen_weights(triangle, edges);
                const double nearness = at.x * triangle.corners[0].nearness + at.y * triangle.corners[1].nearness +
                                        at.z * triangle.corners[2].nearness;
                Nearest& nearest = buffer[static_cast<std::size_t>(y - range.top) * static_cast<std::size_t>(width_) +
                                          static_cast<std::size_t>(x)];
                if (nearness > nearest.nearness) nearest = {nearness, number};
            });
        }
    }

  private:
    int width_, height_;
    std::vector<ScreenTriangle> parts_;
    std::vector<std::vector<std::uint32_t>> of_band_;
};

/// Perspective-correct weights in the whole triangle: those on the screen are divided by w, which is not linear there.
Vec3d true_weights(const ScreenTriangle& part, const EdgeValues& edges) {
    const Vec3d at = screen_weights(part, edges);
    const double over_w[3] = {at.x * part.corners[0].inverse_w, at.y * part.corners[1].inverse_w,
                              at.z * part.corners[2].inverse_w};
    const Vec3d sum =
        part.corners[0].weights * over_w[0] + part.corners[1].weights * over_w[1] + part.corners[2].weights * over_w[2];
    return sum * (1 / (over_w[0] + over_w[1] + over_w[2]));
}

Vec3f blend(const Vec3f (&values)[3], const Vec3d& weights) {
    return values[0] * static_cast<float>(weights.x) + values[1] * static_cast<float>(weights.y) +
           values[2] * static_cast<float>(weights.z);
}

Vec3f unit(const Vec3f& a) { return a * (1 / std::sqrt(dot(a, a))); }

/// Phong's model (docs/paper.md, row 3), with the light of every lamp that is not behind the surface.
Vec3f shade(const RasterScene& scene, const RasterTriangle& triangle, const Vec3d& weights) {
    const CameraView& camera = scene.camera;
    const RasterMaterial& material = scene.materials[triangle.material];
    const Vec3f position = blend(triangle.corners, weights);
    const Vec3f viewer = unit(narrow(camera.orthographic ? -camera.direction : camera.origin - widen(position)));
    const Vec3f blended = blend(triangle.normals, weights);
    const Vec3f own = cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
    Vec3f normal = unit(dot(blended, blended) > 0 ? blended : own);
    if (triangle.sides == FaceSides::double_sided && dot(own, viewer) < 0) normal = -normal;
    Vec3f colour = material.emission + material.ambient * scene.environment.ambient;
    for (const PunctualLight& lamp : scene.lights) {
        const LightRay<float> light = light_at<LightEffects, float>(lamp, widen(position));
        const Vec3f to_light = narrow(light.to_light);
        const float cosine = dot(to_light, normal);
        if (cosine > 0) colour += material.diffuse * light.intensity * cosine;
        const float highlight = dot(normal * (2 * cosine) - to_light, viewer);
        if (highlight > 0) colour += material.specular * light.intensity * std::pow(highlight, material.shininess);
    }
    return colour;
}

Vec3f background_at(const RasterScene& scene, double x, double y) {
    const CameraView& camera = scene.camera;
    const Vec3d& dx = camera.direction_dx;
    const Vec3d& dy = camera.direction_dy;
    return background<float>(scene.environment, narrow(camera.direction + dx * x + dy * y));
}

/// The sums of a band over all passes.
void draw_band(const RasterScene& scene, const Screen& screen, const std::vector<SamplePlace>& places, int band,
               Film& film) {
    std::vector<Nearest> buffer;
    const PixelRange range = screen.range_of(band);
    const auto width = static_cast<std::size_t>(film.width());
    for (const SamplePlace& place : places) {
        screen.draw(band, place, buffer);
        for (int y = range.top; y < range.bottom; ++y) {
            for (int x = 0; x < film.width(); ++x) {
                const Nearest& found =
                    buffer[static_cast<std::size_t>(y - range.top) * width + static_cast<std::size_t>(x)];
                const std::int64_t at_x = x * subpixels + place.x, at_y = y * subpixels + place.y;
                Vec3f colour;
                if (found.part == nothing) {
                    constexpr double pixel = 1 / static_cast<double>(subpixels);
                    colour = background_at(scene, static_cast<double>(at_x) * pixel, static_cast<double>(at_y) * pixel);
                } else {
                    const ScreenTriangle& part = screen.part(found.part);
                    colour =
                        shade(scene, scene.triangles[part.triangle], true_weights(part, edges_at(part, at_x, at_y)));
                }
                film.sums()[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] += widen(colour);
            }
        }
    }
}

}  // namespace

std::vector<SamplePlace> sample_places(const RasterJob& job) {
    // Two words of SplitMix64 (G. Steele et al., OOPSLA 2014) are the shift
    std::uint64_t state = job.seed;
    const auto next = [&state] {
        std::uint64_t z = state += 0x9E3779B97F4A7C15U;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
        return z ^ (z >> 31);
    };
    // Fractions of 2^64: 1 / g and 1 / g^2, with g^3 = g + 1
    constexpr std::uint64_t step_x = 0xC13FA9A902A6328F, step_y = 0x91E10DA5C79E7B1C;
    std::uint64_t x = next(), y = next();
    std::vector<SamplePlace> places;
    for (int i = 0; i < job.samples; ++i) {
        constexpr int shift = 64 - 12;
        static_assert(subpixels == 1 << 12);
        places.push_back({static_cast<std::int64_t>(x >> shift), static_cast<std::int64_t>(y >> shift)});
        x += step_x;
        y += step_y;
    }
    return places;
}

Film rasterise(const RasterScene& scene, const RasterJob& job) {
    const Screen screen(scene, job.width, job.height);
    const std::vector<SamplePlace> places = sample_places(job);
    Film film(job.width, job.height, job.samples);
    std::atomic<int> next_band{0};
    const auto work = [&] {
        for (int band = next_band++; band < screen.bands(); band = next_band++) {
            draw_band(scene, screen, places, band, film);
        }
    };
    const int threads = job.threads > 0 ? job.threads : static_cast<int>(std::thread::hardware_concurrency());
    std::vector<std::jthread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back(work);
    work();
    others.clear();
    return film;
}

std::vector<std::uint32_t> visible_triangles(const RasterScene& scene, int width, int height,
                                             const SamplePlace& place) {
    const Screen screen(scene, width, height);
    std::vector<std::uint32_t> result;
    std::vector<Nearest> buffer;
    for (int band = 0; band < screen.bands(); ++band) {
        screen.draw(band, place, buffer);
        const PixelRange range = screen.range_of(band);
        const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(range.bottom - range.top);
        for (std::size_t i = 0; i < pixels; ++i) {
            const std::uint32_t part = buffer[i].part;
            result.push_back(part == nothing ? nothing : screen.part(part).triangle);
        }
    }
    return result;
}

}  // namespace tandem::bench
