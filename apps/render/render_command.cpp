#include "render/render_command.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/run_main.h"
#include "render/progress.h"
#include "render/render_report.h"
#include "tandem/base/version.h"

namespace tandem {

namespace {

void write_json(const std::string& target, const nlohmann::ordered_json& json) {
    // File names need not be UTF-8.
    const std::string text = json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    if (target != "-") {
        write_file(target, text);
        return;
    }
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

void print_how_to_resume(const RenderCommand& command, std::size_t done, std::size_t total) {
    if (const auto& checkpoint = command.sequence.checkpoint; checkpoint && done < total) {
        std::fprintf(stderr,
                     "tandem-render: interrupted; what is finished is in '%s'. Run the same command again with "
                     "--resume to go on from there, on any backend.\n",
                     checkpoint->file.c_str());
        return;
    }
    const char* advice = command.sequence.force ? " without --force" : "";
    std::fprintf(stderr, "tandem-render: interrupted; %zu of %zu frames are done. ", done, total);
    if (done < total) std::fprintf(stderr, "Run the same command again%s to render the rest.", advice);
    std::fputc('\n', stderr);
}

/// Prints the exposure that the first frame decided; nothing for float formats.
void print_exposure(const FrameRecord& first) {
    const ImageMetadata& metadata = first.metadata;
    if (metadata.exposure_rule.empty()) return;
    const std::string source = first.skipped ? fmt::format("taken from '{}'", first.file)
                                             : fmt::format("derived from frame {}", metadata.frame);
    const std::string sentence = fmt::format("the exposure is {0} stops, {1}; --exposure {0} gives the same result",
                                             metadata.exposure_stops, source);
    std::fprintf(stderr, "tandem-render: %s\n", sentence.c_str());
}

/// Prints why the frames have fewer samples than usual, or shorter paths, if they do.
void print_reduced_quality(const FrameRecord& first) {
    if (first.bounds_per_ray == 0) return;
    const std::string paths = fmt::format(", and --limits sets longer paths than {}", first.metadata.limits);
    const std::string sentence =
        fmt::format(
            "samples per pixel: {}, because large primitives overlap and a ray crosses the bounds of {:.0f} of "
            "them; --spp sets another number{}",
            first.metadata.samples, first.bounds_per_ray, first.has_short_paths ? paths : "") +
        (first.has_opaque_masks ? ". Masked surfaces are opaque" : "");
    std::fprintf(stderr, "tandem-render: %s\n", sentence.c_str());
}

/// Prints the error that a frame has reached, and why it has no more samples.
void print_reached(const FrameRecord& record) {
    const std::string sentence =
        fmt::format("frame {}: error {} (95 %), with {:.1f} samples per pixel on average; stopped by the {}",
                    record.metadata.frame, record.metadata.error, record.mean_samples, record.metadata.stopped_by);
    std::fprintf(stderr, "tandem-render: %s\n", sentence.c_str());
}

/// Whether the frame was stopped before it reached its target error.
bool is_short(const FrameRecord& record, const SequenceOptions& options) {
    return options.target && options.target->error > 0 && record.metadata.stopped_by != to_string(StoppedBy::target);
}

/// The work of each of several processors.
nlohmann::ordered_json members_json(const Capabilities& capabilities) {
    double all = 0;
    for (const MemberWork& work : capabilities.members) all += static_cast<double>(work.samples);
    nlohmann::ordered_json members = nlohmann::ordered_json::array();
    for (const MemberWork& work : capabilities.members) {
        nlohmann::ordered_json member = {{"name", work.name}, {"device", work.device}, {"samples", work.samples}};
        member["share"] = all > 0 ? static_cast<double>(work.samples) / all : 0;
        if (!work.failure.empty()) member["failure"] = work.failure;
        members.push_back(std::move(member));
    }
    return members;
}

}  // namespace

int run_render(const RenderCommand& command, const Scene& scene, Backend& backend,
               const std::atomic<bool>& interrupted) {
    const auto start = std::chrono::steady_clock::now();
    const std::size_t total = static_cast<std::size_t>(command.sequence.frames.count());
    const bool prints_lines = !command.quiet && command.json != "-";
    const bool keeps_records = !command.json.empty();
    if (keeps_records && command.json != "-") check_can_write(command.json);

    nlohmann::ordered_json frames = nlohmann::ordered_json::array();
    const auto& exposure = command.sequence.exposure;
    const bool finds_exposure = exposure && exposure->automatic && !command.quiet;
    bool exposure_is_printed = false, reduction_is_printed = command.quiet, falls_short = false;
    ProgressBar progress(total, !command.quiet && stderr_is_terminal());
    const auto on_frame = [&](const FrameRecord& record) {
        progress.advance(!record.skipped);
        progress.clear();
        if (finds_exposure && !std::exchange(exposure_is_printed, true)) print_exposure(record);
        if (!std::exchange(reduction_is_printed, true)) print_reduced_quality(record);
        if (record.mean_samples > 0 && !command.quiet) print_reached(record);
        falls_short = falls_short || is_short(record, command.sequence);
        if (prints_lines) {
            std::puts(frame_line(record).c_str());
            std::fflush(stdout);
        }
        progress.draw();
        if (keeps_records) frames.push_back(frame_json(record));
    };
    progress.draw();
    const std::size_t done = render_sequence(scene, backend, command.sequence, interrupted, on_frame);
    progress.clear();

    const bool stopped = interrupted;
    if (keeps_records) {
        const Capabilities capabilities = backend.capabilities();
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
        nlohmann::ordered_json report = {{"program", "tandem-render"},    {"version", version()},
                                         {"scene", command.scene},        {"backend", backend.name()},
                                         {"device", capabilities.device}, {"description", capabilities.description},
                                         {"wall_seconds", wall.count()},  {"interrupted", stopped}};
        if (!capabilities.members.empty()) report["members"] = members_json(capabilities);
        report["frames"] = std::move(frames);
        write_json(command.json, report);
    }
    if (!stopped) return falls_short ? exit_short_of_target : exit_done;
    print_how_to_resume(command, done, total);
    return exit_interrupted;
}

}  // namespace tandem
