/// How many samples each tile gets, so that the whole film reaches an error with few samples.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tandem/render/render_target.h"
#include "tandem/render/tile_grid.h"

namespace tandem {

/// The samples of a tile come in parts, each summed from zero and then added to the film. So the bits of the film
/// depend on where parts end, and not on the rounds that they were rendered in. Parts end after 8, 16, 24, 32, 48, 64,
/// 96, 128, ... samples per pixel, and after `most`, the samples of the job. Returns the end of the part that follows
/// `samples`.
[[nodiscard]] int next_part_end(int samples, int most);

/// The samples of every tile in the first round, or the most samples if these are fewer.
inline constexpr int first_round_end = 16;

/// A tile, and its errors as estimated from its samples so far.
struct TileErrors {
    ErrorSums errors;     ///< with `samples`
    double exponent = 1;  ///< the errors fall with the number of samples to the power -exponent
    int samples = 0;      ///< per pixel
    /// errors.sum, estimated from the tiles around it as well; if it is there, the gain of parts is computed from it.
    std::optional<double> likely{};
};

/// Sets `likely` of every tile of a grid: a fifth of it is the mean of the tile and its neighbours, each as if it had
/// the samples of the tile. Rare bright samples are found in some tiles and missed in others where they are as
/// frequent. Judged by its own samples alone, a tile that missed them would get no more samples, and would keep an
/// error that nothing shows.
void look_around(std::vector<TileErrors>& tiles, const TileGrid& grid);

struct Allotment {
    std::vector<int> ends;  ///< by tile: its samples after the round; unchanged if it is not in the round
    bool is_last = false;   ///< the film is predicted to have the error after it
};

/// Allots the next round. Every tile gets one part. Then parts are added in the order of their gain, which is how much
/// they reduce the error of the whole film per sample, to within a factor of two. That ends when the error predicted
/// from `tiles`, plus a standard error, is that of the target, or when no part helps. The error of a tile falls with 1
/// / samples, so tiles get samples about in proportion to their standard deviation, which minimises the number of
/// samples (J. Neyman, "On the Two Different Aspects of the Representative Method", Journal of the Royal Statistical
/// Society 97 (4), 1934).
///
/// If no tile needs more than twice its samples, the round is the last: its samples decide nothing. Otherwise only the
/// tiles that need more than that get samples in this round, twice as many as they have, and the next round is allotted
/// by what is known then. If the target is not reached, and all tiles with an error have the most samples, no tile is
/// in the round. If the target has no error, all tiles get twice as many.
[[nodiscard]] Allotment allot(std::span<const TileErrors> tiles, const RenderTarget& target, int most);

/// The errors of a tile if it had `samples`.
[[nodiscard]] ErrorSums predicted(const TileErrors& tile, int samples);

}  // namespace tandem
