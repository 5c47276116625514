/// Which tiles get how many samples, so that the whole film reaches an error with few.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tandem/render/render_target.h"
#include "tandem/render/tile_grid.h"

namespace tandem {

/// The samples of a tile come in parts, each rendered from zero and added to the film, so that the bits of the film
/// depend on where parts end, and not on who decided that there be more: after 8, 16, 24, 32, 48, 64, 96, 128, ...
/// samples per pixel, and after `most`, the samples of the job. Returns the end of the part that follows `samples`.
[[nodiscard]] int next_part_end(int samples, int most);

/// All tiles get that many in the first round, or the most samples if they are fewer.
inline constexpr int first_round_end = 16;

/// A tile, and its errors as its samples so far show them.
struct TileErrors {
    ErrorSums errors;     ///< with `samples`
    double exponent = 1;  ///< the errors fall with the number of samples to the power -exponent
    int samples = 0;      ///< per pixel
    /// errors.sum as the tiles around suggest it too; what parts gain is judged by it, if it is there.
    std::optional<double> likely{};
};

/// Sets `likely` of every tile of a grid: a fifth of it is the mean of the tile and its neighbours, each as if it had
/// the samples of the tile. Bright samples that are rare are found in some tiles and not in others that have as many of
/// them. By its own samples alone a tile without one would get no more, and would keep an error that nothing shows.
void look_around(std::vector<TileErrors>& tiles, const TileGrid& grid);

struct Allotment {
    std::vector<int> ends;  ///< by tile: the samples that it has after the round; as before if it is not in the round
    bool is_last = false;   ///< after it the film is predicted to have the error
};

/// Allots the next round. Beginning with one more part for each tile, the part that reduces the error of the whole film
/// most per sample, within a factor of two, comes next, until the error that is predicted from `tiles`, with a standard
/// error more, is that of the target, or no part helps. The error of a tile falls with 1 / samples, so this gives
/// samples about in proportion to the standard deviation: what minimises their number (J. Neyman, "On the Two Different
/// Aspects of the Representative Method", Journal of the Royal Statistical Society 97 (4), 1934).
///
/// If no tile needs more than twice its samples, the round is the last: every tile gets at least a part, and what the
/// round shows has decided nothing. Else only tiles that need more get samples, at most twice as many as they have, and
/// the next round is allotted again by what is known then. If the target is not reached, and all tiles with an error
/// have the most samples, no tile is in the round. Without an error in the target, all tiles get twice as many.
[[nodiscard]] Allotment allot(std::span<const TileErrors> tiles, const RenderTarget& target, int most);

/// The errors of a tile if it had `samples`.
[[nodiscard]] ErrorSums predicted(const TileErrors& tile, int samples);

}  // namespace tandem
