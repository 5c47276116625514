/// The range, ticks and positions of a plot's axis.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace tandem {

struct Tick {
    double value = 0;
    std::string label;
};

class AxisScale {
  public:
    /// Covers all finite `values` and ends on ticks. A linear axis of values that are not negative begins at 0. A
    /// logarithmic one covers whole decades (or 1-2-5 steps below two decades), and one more at the low end if some
    /// values are not positive. `pixels` is the length of the axis.
    AxisScale(std::span<const double> values, bool logarithmic, double pixels);

    /// Distance from the low end, in pixels, within [0, pixels].
    [[nodiscard]] double position(double value) const;
    [[nodiscard]] const std::vector<Tick>& ticks() const { return ticks_; }

  private:
    void cover_linear(double least, double most);
    void cover_logarithmic(double least, double most, bool has_zero);

    bool logarithmic_;
    double pixels_;
    double low_ = 0;  ///< of the value, or of its decimal logarithm
    double high_ = 1;
    std::vector<Tick> ticks_;
};

}  // namespace tandem
