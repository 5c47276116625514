#include "tandem/render/allotment.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <utility>

#include "tandem/math/exact_math.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

/// The part of a tile that may come next. Gains are compared by their powers of two, and equal ones are taken in an
/// order that does not depend on the samples. Otherwise noise would choose between tiles that are alike: where samples
/// have two values, as at edges, the mean is far from the truth where the variance seems low, so the tiles with the
/// largest errors would get the fewest samples. From one part to the next the gain halves, so this costs little.
struct Step {
    int power = 0;            ///< of the gain of the whole film's error, per sample
    std::uint64_t order = 0;  ///< neighbours are far apart
    std::size_t tile = 0;

    bool operator<(const Step& other) const { return power != other.power ? power < other.power : order > other.order; }
};

/// The share of a tile's present errors that is left with `samples` samples.
double share_left(const TileErrors& tile, int samples) {
    const double share = static_cast<double>(tile.samples) / samples;
    return tile.exponent == 1 ? share : power<float>(share, tile.exponent);
}

double likely_sum(const TileErrors& tile, int samples) {
    return tile.likely.value_or(tile.errors.sum) * share_left(tile, samples);
}

class Greedy {
  public:
    Greedy(std::span<const TileErrors> tiles, int most) : tiles_(tiles), most_(most), ends_(tiles.size()) {
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            ends_[i] = next_part_end(tiles[i].samples, most);
            total_ += predicted(tiles[i], ends_[i]);
            offer(i);
        }
    }

    /// Takes parts until the film has the error. If it cannot, and no part helps, takes none.
    std::vector<int> run(double mean_of_film) {
        if (cautious_mean(total_) > mean_of_film && nothing_helps()) {
            for (std::size_t i = 0; i < ends_.size(); ++i) ends_[i] = tiles_[i].samples;
        }
        while (cautious_mean(total_) > mean_of_film && !steps_.empty()) {
            const std::size_t i = steps_.top().tile;
            steps_.pop();
            const int end = next_part_end(ends_[i], most_);
            total_ -= predicted(tiles_[i], ends_[i]);
            total_ += predicted(tiles_[i], end);
            ends_[i] = end;
            offer(i);
        }
        return std::move(ends_);
    }

  private:
    [[nodiscard]] bool nothing_helps() const {
        return std::all_of(tiles_.begin(), tiles_.end(),
                           [&](const TileErrors& tile) { return tile.errors.sum == 0 || tile.samples == most_; });
    }
    void offer(std::size_t i) {
        const TileErrors& tile = tiles_[i];
        const int end = next_part_end(ends_[i], most_);
        if (end == ends_[i]) return;
        const double gain = likely_sum(tile, ends_[i]) - likely_sum(tile, end);
        if (!(gain > 0)) return;
        const double per_sample = gain / (tile.errors.pixels * (end - ends_[i]));
        steps_.push({std::ilogb(per_sample), std::uint64_t{i} * 0x9E3779B97F4A7C15U, i});
    }

    std::span<const TileErrors> tiles_;
    int most_;
    std::vector<int> ends_;
    ErrorSums total_;
    std::priority_queue<Step> steps_;
};

}  // namespace

int next_part_end(int samples, int most) {
    if (most < first_round_end) return most;
    std::int64_t end = first_round_end / 2;
    // each step is half of the last power of two
    for (std::int64_t step = end; end <= samples; end += step) {
        if (end >= 4 * step) step *= 2;
    }
    return static_cast<int>(std::min<std::int64_t>(end, most));
}

ErrorSums predicted(const TileErrors& tile, int samples) { return scaled(tile.errors, share_left(tile, samples)); }

void look_around(std::vector<TileErrors>& tiles, const TileGrid& grid) {
    const DefaultFpEnvironment guard;
    constexpr double share_of_neighbours = 0.2;
    const auto at = [&](int column, int row) -> TileErrors& {
        return tiles[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns()) +
                     static_cast<std::size_t>(column)];
    };
    for (int row = 0; row < grid.rows(); ++row) {
        for (int column = 0; column < grid.columns(); ++column) {
            TileErrors& tile = at(column, row);
            ErrorSums around;
            for (int v = std::max(row - 1, 0); v <= std::min(row + 1, grid.rows() - 1); ++v) {
                for (int u = std::max(column - 1, 0); u <= std::min(column + 1, grid.columns() - 1); ++u) {
                    around += predicted(at(u, v), tile.samples);
                }
            }
            const double mean = around.sum / around.pixels * tile.errors.pixels;
            tile.likely = (1 - share_of_neighbours) * tile.errors.sum + share_of_neighbours * mean;
        }
    }
}

Allotment allot(std::span<const TileErrors> tiles, const RenderTarget& target, int most) {
    const DefaultFpEnvironment guard;
    const auto twice = [&](int samples) {
        return static_cast<int>(std::min<std::int64_t>(2 * std::int64_t{samples}, most));
    };
    Allotment result;
    if (target.error == 0) {
        for (const TileErrors& tile : tiles) result.ends.push_back(twice(tile.samples));
        return result;
    }
    result.ends = Greedy(tiles, most).run(mean_of_target(target.error, target.metric));
    result.is_last = true;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        result.is_last = result.is_last && result.ends[i] <= twice(tiles[i].samples);
    }
    if (result.is_last) return result;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const int limit = twice(tiles[i].samples);
        result.ends[i] = result.ends[i] > limit ? limit : tiles[i].samples;
    }
    return result;
}

}  // namespace tandem
