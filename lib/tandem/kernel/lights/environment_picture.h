/// The environment picture: a picture of all directions, and the sampling of directions in proportion to its
/// brightness.
///
/// The picture is equirectangular with its top at +y. Its centre is at -z, u grows to the right (u = 3/4 is +x), and
/// the seam is at +z. `turn` rotates the picture about +y, counter-clockwise seen from above.
///
/// Between the centres of its texels the radiance is linear in the azimuth and in the height y of the unit direction;
/// above the centres of the first row, and below those of the last one, it does not change with the height. So a cell
/// between four centres is a rectangle in these variables, whose area is proportional to the solid angle (Archimedes),
/// and directions can be sampled exactly in proportion to the brightness (r + g) + b. With interpolation linear in the
/// polar angle, as in other programs, they could not. The two differ only in the first rows about the poles.
///
/// The probabilities of the bands, from top to bottom, and of the cells of each band are integers, in units of 2^-31.
/// So the probability that divides a sample is exactly the one with which it was chosen, for any ratio of the brightest
/// texel to the darkest. Every cell that is not black has a probability of at least 2^-62
/// (compile/environment_picture.cpp).
///
/// Tested by tests/kernel/lights/environment_picture_test.cpp.
#pragma once

#include "tandem/kernel/lights/environment_sample.h"
#include "tandem/kernel/sampler/philox.h"
#include "tandem/kernel/texture/texture_view.h"
#include "tandem/math/lookup_table.h"
#include "tandem/math/turns.h"
#include "tandem/math/vec.h"

namespace tandem {

/// A picture has width * height texels, and (height + 1) * width cells: band 0 is the cap above the first row of
/// centres, and band `height` that below the last one.
struct EnvironmentPicture {
    double turn = 0;           ///< rotation, in full turns
    std::uint32_t width = 0;   ///< 1 to 65536; 0: no picture
    std::uint32_t height = 0;  ///< 1 to 65536
    float intensity = 1;       ///< factor for the texels
    std::uint32_t unused = 0;  ///< otherwise padding bytes, undefined
};
static_assert(sizeof(EnvironmentPicture) == 24, "no byte is undefined; scene_hash() reads all");

/// The pointers are to memory of the reader: host or device.
struct EnvironmentPictureView {
    EnvironmentPicture picture;
    const Vec3f* texels;    ///< linear RGB, row by row from the top; finite, not negative
    const double* borders;  ///< (1 - y) / 2 at the upper border of band i; height / 2 + 2, mirrored for the rest
    const std::uint32_t* band_ends;  ///< ends (exclusive) of the ranges below 2^31 that choose a band; height + 1
    const std::uint32_t* cell_ends;  ///< the same for the cells of each band, one band after the other
};

TANDEM_HD bool is_there(const EnvironmentPicture& picture) { return picture.width != 0; }

/// `scene`: a SceneView.
template <class Scene>
TANDEM_HD EnvironmentPictureView view_of(const EnvironmentPicture& picture, const Scene& scene) {
    return {picture, scene.environment_texels, scene.environment_borders, scene.environment_band_ends,
            scene.environment_cell_ends};
}

namespace environment_detail {

/// A place in a cell: x to the right and y downwards, in [0, 1].
template <class Real>
struct CellPoint {
    UInt<Real> band, column;
    Double<Real> x, y;
};

/// The first of the consecutive ranges of integers in `row` of a table of their ends that contains `number`; the last
/// one if none does.
template <class Word>
TANDEM_HD Word find_range(const LookupTable<std::uint32_t>& ends, const Word& row, const Word& number) {
    return bisect<Word>(ends.width, [&](const Word& range) { return !(number < ends.at(row, range)); });
}
/// The length of a range.
template <class Word>
TANDEM_HD Word range_length(const LookupTable<std::uint32_t>& ends, const Word& row, const Word& range) {
    const auto is_first = range == Word(0U);
    const Word before = select(is_first, range, range - Word(1U));
    return ends.at(row, range) - select(is_first, Word(0U), ends.at(row, before));
}

TANDEM_HD LookupTable<std::uint32_t> band_ends(const EnvironmentPictureView& view) {
    return {view.band_ends, view.picture.height + 1};
}
TANDEM_HD LookupTable<std::uint32_t> cell_ends(const EnvironmentPictureView& view) {
    return {view.cell_ends, view.picture.width, view.picture.height + 1};
}

/// The extent of a band, from the nearer pole, so that nothing cancels there: (1 - |y|) / 2 at the border towards the
/// pole, and the difference to the other border.
template <class Real>
struct BandReach {
    Mask<Real> is_southern;
    Double<Real> border, extent;
};

template <class Real>
TANDEM_HD BandReach<Real> band_reach(const EnvironmentPictureView& view, const UInt<Real>& band) {
    using D = Double<Real>;
    using Word = UInt<Real>;
    const Word middle(view.picture.height / 2);
    const Mask<Real> is_southern = middle < band;
    const Word from_pole = select(is_southern, Word(view.picture.height) - band, band);
    const LookupTable<double> borders = {view.borders, view.picture.height / 2 + 2};
    const auto border = [&](std::uint32_t step) { return from_wide<Real>(borders[from_pole + Word(step)]); };
    const D first = border(0);
    return {is_southern, first, border(1) - first};
}

/// The cell and place of a direction. Lanes whose direction is not finite get an arbitrary cell.
template <class Real>
TANDEM_HD CellPoint<Real> cell_towards(const EnvironmentPictureView& view, const Vec3<Double<Real>>& direction) {
    using D = Double<Real>;
    const D zero(0.0F);
    const D one(1.0F);
    const D two(2.0F);
    const D width(to_float(view.picture.width));
    const D height(to_float(view.picture.height));
    const D radius2 = direction.x * direction.x + direction.z * direction.z;
    const D radius = square_root(radius2);

    const D u = D(0.5F) + (constant<D>(view.picture.turn) + atan2_turns<Real>(direction.x, -direction.z));
    const TexelPair<D> columns = texels_around(u, Wrap::repeat, Filter::linear, width);
    // the order of arguments turns a NaN into `height`
    const D rows = lesser(height, atan2_turns<Real>(radius, direction.y) * (height + height) + D(0.5F));
    const D band = floor_of(rows);
    CellPoint<Real> point = {to_word(band), to_word(columns.first), columns.weight, zero};

    const BandReach<Real> reach = band_reach<Real>(view, point.band);
    const D up = select(reach.is_southern, -direction.y, direction.y);  // towards the nearer pole
    const D length2 = radius2 + direction.y * direction.y;
    const D length = square_root(select(length2 > zero, length2, one));
    const D upward = length + greater(up, zero);
    const D depth = select(up > zero, radius2 / (two * length * upward), (length - up) / (two * length));
    const D along = greater(lesser(one, (depth - reach.border) / reach.extent), zero);
    point.y = select(reach.is_southern, one - along, along);
    return point;
}

/// The direction of a place in a cell.
template <class Real>
TANDEM_HD Vec3<Double<Real>> direction_of(const EnvironmentPictureView& view, const CellPoint<Real>& point) {
    using D = Double<Real>;
    const D one(1.0F);
    const D half(0.5F);
    const BandReach<Real> reach = band_reach<Real>(view, point.band);
    const D along = select(reach.is_southern, one - point.y, point.y);
    const D depth = reach.border + along * reach.extent;
    const D up = one - (depth + depth);
    const D radius = square_root(depth * (one - depth));
    const D column = widen(from_uint<Float<Real>>(point.column));
    const D u = (column + (half + point.x)) / D(to_float(view.picture.width));
    const SineCosine<Real> azimuth = sin_cos_turns<Real>((u - half) - constant<D>(view.picture.turn));
    return {(radius + radius) * azimuth.sine, select(reach.is_southern, -up, up),
            -((radius + radius) * azimuth.cosine)};
}

/// The colours at the corners of a cell: upper left, upper right, lower left, lower right.
template <class Real>
struct CellColours {
    Vec3<Double<Real>> corner[4];
};

template <class Real>
TANDEM_HD CellColours<Real> colours_of(const EnvironmentPictureView& view, const CellPoint<Real>& point) {
    using D = Double<Real>;
    using Word = UInt<Real>;
    const EnvironmentPicture& picture = view.picture;
    const Word zero(0U), one(1U);
    const Word height(picture.height), width(picture.width);
    const Word upper = select(zero < point.band, point.band - one, zero);
    const Word lower = select(point.band < height, point.band, upper);
    const Word next = point.column + one;
    const Word right = select(next < width, next, zero);
    const float* first = &view.texels->x;
    const auto texel = [&](const Word& row, const Word& column) {
        const auto channel = [&](int c) {
            const LookupTable<float, 3> channels = {first + c, picture.width, picture.height};
            return widen(Float<Real>(channels.at(row, column)));
        };
        return Vec3<D>{channel(0), channel(1), channel(2)};
    };
    return {{texel(upper, point.column), texel(upper, right), texel(lower, point.column), texel(lower, right)}};
}

/// Values at the corners of a cell, in the order of CellColours.
template <class D>
struct Corners {
    D value[4];
};

/// a at 0 and b at 1; exact where they are equal.
template <class D>
TANDEM_HD D between(const D& a, const D& b, const D& x) {
    return a + x * (b - a);
}
template <class D>
TANDEM_HD D between(const Corners<D>& c, const D& x, const D& y) {
    return between(between(c.value[0], c.value[1], x), between(c.value[2], c.value[3], x), y);
}

template <class Real>
TANDEM_HD Vec3<Real> radiance_at(const EnvironmentPicture& picture, const CellColours<Real>& colours,
                                 const CellPoint<Real>& point) {
    using D = Double<Real>;
    const auto channel = [&](int c) {
        const Corners<D> corners = {
            {colours.corner[0][c], colours.corner[1][c], colours.corner[2][c], colours.corner[3][c]}};
        return to_real<Real>(between(corners, point.x, point.y) * D(picture.intensity));
    };
    return {channel(0), channel(1), channel(2)};
}

/// The brightness at the corners, which the density is proportional to.
template <class Real>
TANDEM_HD Corners<Double<Real>> brightness_of(const CellColours<Real>& colours) {
    const auto sum = [](const Vec3<Double<Real>>& a) { return (a.x + a.y) + a.z; };
    return {{sum(colours.corner[0]), sum(colours.corner[1]), sum(colours.corner[2]), sum(colours.corner[3])}};
}

/// The density at a place in a cell: the probability of the cell over its solid angle, times the brightness of the
/// place relative to the mean of the cell.
template <class Real>
TANDEM_HD Double<Real> density_at(const EnvironmentPictureView& view, const Corners<Double<Real>>& brightness,
                                  const CellPoint<Real>& point) {
    using D = Double<Real>;
    const EnvironmentPicture& picture = view.picture;
    const UInt<Real> of_band = range_length(band_ends(view), UInt<Real>(0U), point.band);
    const UInt<Real> of_cell = range_length(cell_ends(view), point.band, point.column);
    const D probability = from_wide<Real>(to_wide(of_band) * (to_wide(of_cell) * Wide<Real>(0x1p-62)));
    const D extent = band_reach<Real>(view, point.band).extent;
    const D& a = brightness.value[0];
    const D mean = ((a + brightness.value[1]) + (brightness.value[2] + brightness.value[3])) * D(0.25F);
    const Mask<Real> is_lit = mean > D(0.0F);
    const D relative = between(brightness, point.x, point.y) / select(is_lit, mean, D(1.0F));
    const D cells_per_steradian = D(to_float(picture.width)) * constant<D>(inverse_pi / 4) / extent;
    return select(is_lit, (probability * cells_per_steradian) * relative, D(0.0F));
}

/// Samples a number in [0, 1] with a density that is linear from `a` at 0 to `b` at 1, both >= 0. Gives 0 where both
/// are 0.
/// Method: inverts the distribution function, in a form that does not cancel and divides by no difference.
template <class D>
TANDEM_HD D sample_linear(const D& a, const D& b, const D& u) {
    const D zero(0.0F);
    const D one(1.0F);
    const D sum = a + b;
    const D p = a / select(sum > zero, sum, one);
    const D q = one - p;
    const D divisor = p + square_root((one - u) * (p * p) + u * (q * q));
    return lesser(select(divisor > zero, u / select(divisor > zero, divisor, one), zero), one);
}

}  // namespace environment_detail

/// The environment along `direction`, whose length is within [1e-15, 1e15].
///
/// Gives:  the radiance: the exact interpolation of the texels for a direction within 2^-48 (the tier fast: 2^-18) of
///         the given one, rounded once; exact where the four texels are equal. The density is that of
///         sample_environment(), in full precision; near the border of two cells it may be that of the neighbour.
/// Method: finds the cell by the azimuth and the polar angle, and the place in it by
///         (1 - |y|) / 2 = r^2 / (2 l (l + |y|)), which does not cancel at the poles.
template <class Real>
TANDEM_HD EnvironmentSight<Real> see_environment(const EnvironmentPictureView& view,
                                                 const Vec3<Double<Real>>& direction) {
    using namespace environment_detail;
    const CellPoint<Real> point = cell_towards<Real>(view, direction);
    const CellColours<Real> colours = colours_of<Real>(view, point);
    return {radiance_at<Real>(view.picture, colours, point),
            density_at<Real>(view, brightness_of<Real>(colours), point)};
}

/// Only its radiance.
template <class Real>
TANDEM_HD Vec3<Real> emitted(const EnvironmentPictureView& view, const Vec3<Double<Real>>& direction) {
    return see_environment<Real>(view, direction).radiance;
}

/// Only its density, 1/sr.
template <class Real>
TANDEM_HD Double<Real> pdf_of(const EnvironmentPictureView& view, const Vec3<Double<Real>>& direction) {
    return see_environment<Real>(view, direction).pdf;
}

/// Samples a direction in proportion to the brightness (r + g) + b, with four uniform words.
///
/// Gives: a unit vector within 2^-50; brightness / pdf is the same for all samples, up to the rounding of probabilities
///        to multiples of 2^-31: a relative error of 2^-31 over the probability of the cell in its band, or of the
///        band. For a black picture the density is 0.
/// Method: chooses a band, then one of its cells, then a place in it by inversion of the bilinear density.
/// Source: M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 3rd edition, 2016, sec. 14.2.4, for the two
///         steps from marginal to conditional distribution.
template <class Real>
TANDEM_HD EnvironmentSample<Real> sample_environment(const EnvironmentPictureView& view,
                                                     const PhiloxBlock<UInt<Real>>& random) {
    using namespace environment_detail;
    using D = Double<Real>;
    const EnvironmentPicture& picture = view.picture;
    CellPoint<Real> point;
    point.band = find_range(band_ends(view), UInt<Real>(0U), random.word[0] >> 1);
    point.column = find_range(cell_ends(view), point.band, random.word[1] >> 1);
    const CellColours<Real> colours = colours_of<Real>(view, point);
    const Corners<D> brightness = brightness_of<Real>(colours);
    const auto& [upper_left, upper_right, lower_left, lower_right] = brightness.value;
    point.y = sample_linear(upper_left + upper_right, lower_left + lower_right,
                            widen(to_unit_interval<Real>(random.word[2])));
    point.x = sample_linear(between(upper_left, lower_left, point.y), between(upper_right, lower_right, point.y),
                            widen(to_unit_interval<Real>(random.word[3])));
    return {direction_of<Real>(view, point), radiance_at<Real>(picture, colours, point),
            density_at<Real>(view, brightness, point)};
}

}  // namespace tandem
