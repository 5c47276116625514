/// Work that several processors share: each takes one part after another from what is left.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

namespace tandem {

/// Units of work, such as the rows of a film or rays, numbered from 0.
class Division {
  public:
    struct Part {
        std::size_t first = 0, count = 0;
    };

    /// Parts begin and end at multiples of `step`, except at the end of the work.
    explicit Division(std::size_t units, std::size_t step = 1) : step_(step) {
        if (units > 0) open_.push_back({0, units});
    }

    [[nodiscard]] bool is_empty() const { return open_.empty(); }
    [[nodiscard]] std::size_t left() const {
        std::size_t units = 0;
        for (const Part& part : open_) units += part.count;
        return units;
    }

    /// Takes about `wanted` units, at least one; nothing if nothing is left. Never leaves less than half of that.
    [[nodiscard]] std::optional<Part> take(std::size_t wanted) {
        if (open_.empty()) return std::nullopt;
        Part& front = open_.front();
        std::size_t count = (std::max<std::size_t>(wanted, 1) + step_ - 1) / step_ * step_;
        if (count + count / 2 > front.count) count = front.count;
        const Part taken{front.first, count};
        front.first += count;
        front.count -= count;
        if (front.count == 0) open_.pop_front();
        return taken;
    }

    /// Returns a part that was taken and not done. It is taken again before others.
    void give_back(const Part& part) { open_.push_front(part); }

  private:
    std::size_t step_;
    std::deque<Part> open_;
};

/// A processor that takes part in the work.
struct Worker {
    double pace = 0;  ///< seconds for a unit; 0: not known yet
    double busy = 0;  ///< seconds until it has finished the parts that it took
};

/// Workers that are less than twice as slow as the fastest get the mean pace of these. The rows of an image may differ
/// much in cost, so the times of two workers for different rows do not tell which of them is somewhat faster; and if
/// one is, it takes more parts.
inline void level(std::vector<Worker>& workers) {
    double least = std::numeric_limits<double>::infinity(), sum = 0, near = 0;
    for (const Worker& w : workers) {
        if (w.pace > 0) least = std::min(least, w.pace);
    }
    for (const Worker& w : workers) {
        if (w.pace > 0 && w.pace < 2 * least) sum += w.pace, ++near;
    }
    for (Worker& w : workers) {
        if (w.pace > 0 && w.pace < 2 * least) w.pace = sum / near;
    }
}

/// The units, of those that are left, that a worker should do so that all end at the same time. Workers whose pace is
/// not known count as the mean of the others.
[[nodiscard]] inline double fair_portion(const std::vector<Worker>& workers, std::size_t worker, std::size_t left) {
    if (left == 0) return 0;
    double known = 0, speeds = 0;
    for (const Worker& w : workers) {
        if (w.pace > 0) speeds += 1 / w.pace, ++known;
    }
    const auto speed = [&](const Worker& w) { return w.pace > 0 ? 1 / w.pace : known > 0 ? speeds / known : 1; };
    // Those that are busy beyond the common end do nothing more; without them the end comes later, or stays.
    double end = std::numeric_limits<double>::infinity();
    while (true) {
        double units = static_cast<double>(left), all = 0;
        for (const Worker& w : workers) {
            if (w.busy < end) units += w.busy * speed(w), all += speed(w);
        }
        const double sooner = units / all;
        const bool is_last = std::none_of(workers.begin(), workers.end(),
                                          [&](const Worker& w) { return w.busy < end && w.busy >= sooner; });
        if (is_last) return std::max(0.0, (sooner - workers[worker].busy) * speed(workers[worker]));
        end = sooner;
    }
}

/// How much a worker takes of its portion: one of `steps` equal parts, so that later parts can make up for unforeseen
/// costs, such as rows that cost more than others; all of it if less than `least` would be left. So the parts become
/// smaller towards the end. Before its pace is known it takes a sixteenth, to learn it. (Guided self-scheduling: C.
/// Polychronopoulos, D. Kuck, IEEE Transactions on Computers C-36(12), 1987.)
[[nodiscard]] inline std::size_t part_size(double portion, int steps, bool is_known, std::size_t least) {
    const double part = portion / (is_known ? steps : 16);
    if (is_known && portion - part < static_cast<double>(least)) {
        return std::max({static_cast<std::size_t>(std::ceil(portion)), least, std::size_t{1}});
    }
    return std::max({static_cast<std::size_t>(part), least, std::size_t{1}});
}

}  // namespace tandem
