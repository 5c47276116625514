#include "accuracy/report_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

bool overlap(const Interval& a, const Interval& b) { return a.low <= b.high && b.low <= a.high; }

/// "takes 1.31 (1.28 to 1.34) times as long as strict".
std::string time_clause(const SweepPoint& point, const SweepPoint& baseline) {
    return fmt::format("takes {} times as long as {}",
                       format_ratio(ratio_of_medians(point.row.seconds, baseline.row.seconds)), baseline.setting.name);
}

/// How the error of a setting compares with the baseline's, both with the same samples.
std::string error_clause(const SweepPoint& point, const SweepPoint& baseline) {
    const ErrorEstimate& theirs = point.error(Metric::rmse);
    const ErrorEstimate& ours = baseline.error(Metric::rmse);
    if (overlap(theirs.interval, ours.interval)) {
        return fmt::format("its error cannot be told from that of {}", baseline.setting.name);
    }
    if (ours.value <= 0 || theirs.value <= 0) {
        return fmt::format("its RMSE is {}, that of {} {}", in_words(theirs), baseline.setting.name, in_words(ours));
    }
    return fmt::format("its RMSE is {} times as large", format_number(theirs.value / ours.value));
}

std::string price_sentence(const SceneSweep& sweep, const std::string& backend) {
    const std::vector<const SweepPoint*> ladder = sweep.ladder(backend, sweep.plan.settings.front());
    if (ladder.size() < 2) {
        return fmt::format("On {}, the RMSE of {} is {} in {}; the price of a digit needs more numbers of samples.",
                           backend, ladder.front()->setting.name, in_words(ladder.front()->error(Metric::rmse)),
                           format_seconds(ladder.front()->seconds()));
    }
    const double price = price_law(sweep, backend).price_of_a_digit();
    const SweepPoint& least = *ladder.front();
    const SweepPoint& most = *ladder.back();
    const std::string ends =
        fmt::format("the RMSE is {} in {} ({} spp) and {} in {} ({} spp)", in_words(least.error(Metric::rmse)),
                    format_seconds(least.seconds()), least.samples, in_words(most.error(Metric::rmse)),
                    format_seconds(most.seconds()), most.samples);
    if (price > 1e6) {
        return fmt::format("On {}, more samples do not reduce the error of {}: {}.", backend, least.setting.name, ends);
    }
    return fmt::format("On {}, a tenth of the error costs {} times the time: {}.", backend, format_number(price), ends);
}

bool has_failed(const SceneSweep& sweep, const std::string& backend, const Setting& setting) {
    return !sweep.ladder(backend, setting).back()->failures.empty();
}

std::string failure_sentence(const SceneSweep& sweep, const std::string& backend, const Setting& setting) {
    return fmt::format("{} on {} failed: {}.", setting.name, backend,
                       fmt::join(sweep.ladder(backend, setting).back()->failures, "; "));
}

/// Compares a setting that has not failed with the baseline, at the most samples.
std::string setting_sentence(const SceneSweep& sweep, const std::string& backend, const Setting& setting) {
    const SweepPoint& point = *sweep.ladder(backend, setting).back();
    const SweepPoint& baseline = *sweep.ladder(backend, sweep.plan.settings.front()).back();
    std::string text = fmt::format("{} on {} {} at {} spp, and {}", setting.name, backend, time_clause(point, baseline),
                                   point.samples, error_clause(point, baseline));
    const std::vector<const SweepPoint*> ladder = sweep.ladder(backend, setting);
    const ErrorEstimate& first = ladder[ladder.size() > 1 ? ladder.size() - 2 : 0]->error(Metric::rmse);
    const bool stays = ladder.size() > 1 && point.error(Metric::rmse).value > 0.8 * first.value &&
                       !overlap(point.error(Metric::rmse).interval, baseline.error(Metric::rmse).interval);
    if (!has_the_image_of_the_baseline(setting)) {
        text += fmt::format(
            ", each from references with its own filter; the RMSE of its converged image from that of {} is {}",
            baseline.setting.name, in_words(sweep.difference_of(setting)));
    }
    if (setting.axis == Axis::sampler) {
        const auto ours = convergence(sweep, backend, setting);
        const auto theirs = convergence(sweep, backend, sweep.plan.settings.front());
        if (ours && theirs) {
            text += fmt::format("; it falls with the samples to the power {}, that of {} {}", in_words(*ours),
                                baseline.setting.name, in_words(*theirs));
        }
    }
    return text + (stays ? "; more samples hardly reduce it." : ".");
}

/// The settings on the front of a backend, each with its samples.
std::string choice_sentence(const SceneSweep& sweep, const std::string& backend) {
    std::vector<PricedError> priced;
    std::vector<const SweepPoint*> points;
    for (const SweepPoint& point : sweep.points) {
        if (point.row.backend != backend || !point.failures.empty()) continue;
        if (!has_the_image_of_the_baseline(point.setting)) continue;
        points.push_back(&point);
        priced.push_back(point.priced(Metric::rmse));
    }
    const auto by = dominating(priced);
    std::vector<std::string> chosen;
    for (const Setting& setting : sweep.plan.settings) {
        std::vector<int> samples;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!by[i] && points[i]->setting.name == setting.name) samples.push_back(points[i]->samples);
        }
        if (!samples.empty()) chosen.push_back(fmt::format("{} ({} spp)", setting.name, fmt::join(samples, ", ")));
    }
    return fmt::format("Worth their time on {}, since nothing measured is both faster and closer: {}.", backend,
                       fmt::join(chosen, "; "));
}

/// The time of one backend over that of another for the same error, at the most samples.
std::string backends_sentence(const SceneSweep& sweep, const std::string& slow, const std::string& fast) {
    const SweepPoint& a = *sweep.ladder(slow, sweep.plan.settings.front()).back();
    const SweepPoint& b = *sweep.ladder(fast, sweep.plan.settings.front()).back();
    const std::string bits = b.differing == 0
                                 ? "the image is the same, bit for bit"
                                 : fmt::format("{} of the pixels differ in a bit", format_share(b.differing));
    return fmt::format("For the error of {} spp, {} takes {} times as long as {}: {}.", a.samples, slow,
                       format_ratio(ratio_of_medians(a.row.seconds, b.row.seconds)), fast, bits);
}

}  // namespace

std::string in_words(const ErrorEstimate& error) {
    if (!error.resolved) {
        return error.interval.high > 0 ? fmt::format("below {}", format_number(error.interval.high)) : "0";
    }
    return fmt::format("{} ({} to {})", format_number(error.value), format_number(error.interval.low),
                       format_number(error.interval.high));
}

std::string in_words(const Summary& seconds) {
    if (!seconds.interval) return format_summary(seconds);
    return fmt::format("{} ({} to {})", format_seconds(seconds.median), format_seconds(seconds.interval->low),
                       format_seconds(seconds.interval->high));
}

PowerLaw price_law(const SceneSweep& sweep, const std::string& backend) {
    std::vector<TimeAndError> points;
    for (const SweepPoint* point : sweep.ladder(backend, sweep.plan.settings.front())) {
        const ErrorEstimate& error = point->error(Metric::rmse);
        if (error.resolved && point->failures.empty()) points.push_back({point->seconds(), error.value});
    }
    return fit_power_law(points);
}

std::optional<Exponent> convergence(const SceneSweep& sweep, const std::string& backend, const Setting& setting) {
    std::vector<SamplesAndError> points;
    for (const SweepPoint* point : sweep.ladder(backend, setting)) {
        const ErrorEstimate& error = point->error(Metric::rmse);
        if (error.resolved && point->failures.empty()) points.push_back({static_cast<double>(point->samples), error});
    }
    return fit_exponent(points);
}

std::string in_words(const Exponent& exponent) {
    return fmt::format("{:.2f} ({:.2f} to {:.2f})", exponent.value, exponent.interval.low, exponent.interval.high);
}

std::vector<std::string> answers(const SceneSweep& sweep, const std::vector<SweepBackend>& backends) {
    std::vector<std::string> sentences;
    for (const SweepBackend& backend : backends) {
        sentences.push_back(price_sentence(sweep, backend.name));
        for (const Setting& setting : sweep.plan.settings) {
            if (!runs_on(setting, backend.name) || !has_failed(sweep, backend.name, setting)) continue;
            sentences.push_back(failure_sentence(sweep, backend.name, setting));
        }
        sentences.push_back(choice_sentence(sweep, backend.name));
        if (&backend != &backends.front()) {
            sentences.push_back(backends_sentence(sweep, backends.front().name, backend.name));
        }
    }
    return sentences;
}

std::vector<std::string> comparisons(const SceneSweep& sweep, const std::vector<SweepBackend>& backends) {
    std::vector<std::string> sentences;
    for (const SweepBackend& backend : backends) {
        for (const Setting& setting : sweep.plan.settings) {
            if (setting.axis == Axis::baseline || !runs_on(setting, backend.name)) continue;
            if (has_failed(sweep, backend.name, setting)) continue;
            sentences.push_back(setting_sentence(sweep, backend.name, setting));
        }
    }
    sentences.insert(sentences.end(), sweep.plan.biases.begin(), sweep.plan.biases.end());
    return sentences;
}

std::string meaning_of_words() {
    return "A setting is a way to render the scene: strict, the default, has the same bits on every backend; fast "
           "approximates; precise computes in double; the others are strict with one thing changed. spp is the number "
           "of samples per pixel. RMSE is the root of the mean square error against the reference, in units of "
           "radiance: white is 1. The reference of a filter is drawn with that filter. Each point of a plot is a "
           "setting with a number of samples on a backend (cpu, or "
           "cuda for the GPU): further left is faster, further down is closer to the reference, and the dotted line "
           "joins the points that no other beats. Point at a mark to see its name and its numbers. Numbers in "
           "parentheses are 95 % intervals.";
}

std::string not_varied(const SweepOptions& options) {
    return fmt::format(
        "The size of the image ({} x {} pixels), the frame (0), the camera, the clamp (there is none) and "
        "the sums of samples (double). Threads ({}), instruction set and clocks. Axes other than samples vary one at a "
        "time.",
        options.size.width, options.size.height,
        options.threads == 0 ? std::string("one per core") : fmt::format("{}", options.threads));
}

}  // namespace tandem::bench
