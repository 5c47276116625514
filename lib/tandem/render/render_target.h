/// What ends a render, instead of a number of samples: an error, or time.
#pragma once

#include <limits>
#include <string>

#include "tandem/film/error_estimate.h"
#include "tandem/images/display.h"
#include "tandem/render/render_job.h"

namespace tandem {

struct RenderTarget {
    double error = 0;  ///< in the unit of the metric; 0: none, so that time or the samples of the job end it
    ErrorMetric metric = ErrorMetric::rmse;
    double seconds = std::numeric_limits<double>::infinity();  ///< of rendering
    Display display{};                                         ///< for flip
};

/// Throws InputError that names an invalid field, or the samples of a job that are too few to have a variance.
void check(const RenderTarget& target, const RenderJob& job);

/// "rmse 0.01 within 60 s".
[[nodiscard]] std::string to_string(const RenderTarget& target);

/// The error alone: "rmse 0.01", or "time" if there is none.
[[nodiscard]] std::string error_text(const RenderTarget& target);

}  // namespace tandem
