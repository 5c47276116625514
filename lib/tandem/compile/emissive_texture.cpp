#include "tandem/compile/emissive_texture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tandem/kernel/shapes/parametrisation.h"

namespace tandem {

namespace {

constexpr std::size_t block_edge = 8;
/// The least weight of a light whose texture may not be black everywhere, relative to a white texture.
constexpr double least_brightness = 1.0 / 256;

/// Texels along one axis, both ends included.
using Run = std::pair<std::size_t, std::size_t>;

/// The texels of an axis of `size` that the unwrapped range from `first` to `last` shows.
std::vector<Run> runs_of(double first, double last, std::size_t size, Wrap wrap) {
    const auto edge = static_cast<double>(size);
    if (wrap == Wrap::clamp_to_edge) {
        const auto inside = [&](double i) { return static_cast<std::size_t>(std::clamp(i, 0.0, edge - 1)); };
        return {{inside(first), inside(last)}};
    }
    if (!(last - first < 2 * edge)) return {{0, size - 1}};
    std::vector<Run> runs;
    for (double period = std::floor(first / edge); period * edge <= last; ++period) {
        const double from = std::max(first, period * edge) - period * edge;
        const double to = std::min(last, (period + 1) * edge - 1) - period * edge;
        const bool backward = wrap == Wrap::mirrored_repeat && std::fmod(period, 2) != 0;
        runs.emplace_back(static_cast<std::size_t>(backward ? edge - 1 - to : from),
                          static_cast<std::size_t>(backward ? edge - 1 - from : to));
    }
    return runs;
}

}  // namespace

bool EmissiveTextures::Blocks::any(std::size_t x0, std::size_t x1, std::size_t y0, std::size_t y1) const {
    const auto sum = [&](std::size_t x, std::size_t y) { return bright[y * (columns + 1) + x]; };
    const std::size_t left = x0 / block_edge, right = x1 / block_edge + 1;
    const std::size_t top = y0 / block_edge, bottom = y1 / block_edge + 1;
    return sum(right, bottom) + sum(left, top) != sum(left, bottom) + sum(right, top);
}

const EmissiveTextures::Blocks& EmissiveTextures::blocks_of(std::uint32_t texture) {
    const auto [known, is_new] = blocks_.try_emplace(texture);
    Blocks& blocks = known->second;
    if (!is_new) return blocks;
    const TextureDescriptor& d = scene_.textures.textures[texture];
    blocks.columns = (d.width + block_edge - 1) / block_edge;
    const std::size_t rows = (d.height + block_edge - 1) / block_edge;
    blocks.bright.assign((blocks.columns + 1) * (rows + 1), 0);
    const std::uint32_t* texel = scene_.textures.texels + d.first_texel;
    const auto at = [&](std::size_t x, std::size_t y) -> std::uint32_t& {
        return blocks.bright[y * (blocks.columns + 1) + x];
    };
    for (std::size_t y = 0; y < d.height; ++y) {
        for (std::size_t x = 0; x < d.width; ++x, ++texel) {
            if ((*texel & 0x00FFFFFFU) != 0) at(x / block_edge + 1, y / block_edge + 1) = 1;
        }
    }
    for (std::size_t y = 1; y <= rows; ++y) {
        for (std::size_t x = 1; x <= blocks.columns; ++x) at(x, y) += at(x - 1, y) + at(x, y - 1) - at(x - 1, y - 1);
    }
    return blocks;
}

bool EmissiveTextures::may_shine(const TextureUse& use, std::span<const Point> points) {
    const TextureDescriptor& d = scene_.textures.textures[use.texture];
    const auto on_texture = [](const float* row, const Point& p) {
        return double{row[0]} * p.u + double{row[1]} * p.v + double{row[2]};
    };
    double left = HUGE_VAL, right = -HUGE_VAL, top = HUGE_VAL, bottom = -HUGE_VAL;
    for (const Point& point : points) {
        const double x = on_texture(use.u_row, point), y = on_texture(use.v_row, point);
        if (!std::isfinite(x) || !std::isfinite(y)) return true;
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
    }
    // one texel more than the filter's support, for rounding
    const auto runs = [](double from, double to, std::uint32_t size, Wrap wrap) {
        return runs_of(std::floor(from * size) - 2, std::floor(to * size) + 2, size, wrap);
    };
    const Blocks& blocks = blocks_of(use.texture);
    for (const auto& [x0, x1] : runs(left, right, d.width, d.wrap_s)) {
        for (const auto& [y0, y1] : runs(top, bottom, d.height, d.wrap_t)) {
            if (blocks.any(x0, x1, y0, y1)) return true;
        }
    }
    return false;
}

double EmissiveTextures::level_at(const TextureUse& use, const Point& surface) const {
    const Rgba<double> texel = sample<double>(scene_.textures, use, surface.u, surface.v);
    return (texel.r + texel.g + texel.b) / 3;
}

double EmissiveTextures::on_triangle(const TextureUse& use, const Vec2f& a, const Vec2f& b, const Vec2f& c) {
    const Point corners[] = {{a.x, a.y}, {b.x, b.y}, {c.x, c.y}};
    if (!may_shine(use, corners)) return 0;
    // the centres of 16 equal triangles
    constexpr int steps = 4;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        for (int k = 0; k < 2 * (steps - i) - 1; ++k) {
            const double along_b = (i + (k % 2 == 0 ? 1.0 : 2.0) / 3) / steps;
            const double along_c = (k / 2 + (k % 2 == 0 ? 1.0 : 2.0) / 3) / steps;
            const double rest = 1 - along_b - along_c;
            sum += level_at(use, {rest * corners[0].u + along_b * corners[1].u + along_c * corners[2].u,
                                  rest * corners[0].v + along_b * corners[1].v + along_c * corners[2].v});
        }
    }
    return std::max(sum / (steps * steps), least_brightness);
}

double EmissiveTextures::on_sphere(const TextureUse& use) {
    const Point whole[] = {{0, 0}, {1, 1}};
    if (!may_shine(use, whole)) return 0;
    constexpr int rows = 16, columns = 32;
    double sum = 0;
    for (int row = 0; row < rows; ++row) {  // of equal area
        const double height = 1 - (2 * row + 1.0) / rows;
        const double v = 2 * atan2_turns<double>(std::sqrt((1 - height) * (1 + height)), height);
        for (int column = 0; column < columns; ++column) sum += level_at(use, {(column + 0.5) / columns, v});
    }
    return std::max(sum / (rows * columns), least_brightness);
}

double EmissiveTextures::brightness(std::uint32_t primitive) {
    if (!has_textures(scene_.textures)) return 1;
    const TextureUse& use = scene_.textures.materials[scene_.material_of[primitive]].emission;
    if (use.texture == no_texture) return 1;
    double result = 1;
    visit_primitive(scene_, primitive, [&](const auto& body) {
        using Body = std::decay_t<decltype(body)>;
        const Vec2f* values = scene_.texcoords + use.slot * corner_count<Body>;
        if constexpr (std::is_same_v<Body, Sphere>) {
            result = on_sphere(use);
        } else if constexpr (std::is_same_v<Body, Triangle>) {
            const auto corner = parametrisation_detail::corners_of(body, values);
            result = on_triangle(use, corner.uv[0], corner.uv[1], corner.uv[2]);
        } else if constexpr (std::is_same_v<Body, Quad>) {
            const auto corner = parametrisation_detail::corners_of(body, values);
            result = (on_triangle(use, corner.uv[0], corner.uv[1], corner.uv[2]) +
                      on_triangle(use, corner.uv[0], corner.uv[2], corner.uv[3])) /
                     2;
        }
    });
    return result;
}

}  // namespace tandem
