#include "paper.h"

#include <fmt/format.h>

#include <algorithm>

#include "paper_figures.h"
#include "paper_plots.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

/// The median of a measured row.
double middle(const BenchmarkRow& row) { return median(row.seconds); }

/// How many times faster `fast` is, by medians over the frames that both have.
std::string times_faster(const BenchmarkRow& slow, const BenchmarkRow& fast) {
    if (&slow == &fast) return "1";
    const auto factor = factor_over(slow, fast);
    return factor ? format_ratio(factor->ratio) : "not measured";
}

std::string short_factor(const BenchmarkRow& slow, const BenchmarkRow& fast) {
    const auto factor = factor_over(slow, fast);
    return factor ? format_number(factor->ratio.value) : "an unknown factor";
}

Table ladder_table(PaperRows& rows) {
    Table table{
        "Each row renders the same scene at the same size with the same number of samples. Time: median ± median "
        "absolute deviation over the frames measured. Factors: ratio of medians over the frames that both rows "
        "have, with the 95 % interval",
        {{"What"},
         {"Frames", true},
         {"Time per frame", true},
         {"Samples/s", true},
         {"Factor over the paper's CPU program", true},
         {"Factor over the same with -O3 on all threads", true}},
        {}};
    for (const BenchmarkRow* row : rows.all()) {
        if (row->seconds.empty()) continue;
        table.rows.push_back({row->label, fmt::format("{}", row->seconds.size()),
                              format_summary(summarize(row->seconds)), format_count(samples_per_second(*row)),
                              times_faster(rows.naive_o0, *row), times_faster(rows.naive_o3_threads, *row)});
    }
    return table;
}

void explain_factor(const PaperMeasurements& m, Report& report) {
    const PaperRows& rows = m.rows;
    auto& blocks = report.blocks;
    blocks.emplace_back(Heading{"Where the factor comes from"});
    blocks.emplace_back(Paragraph{fmt::format(
        "The paper compares a GPU with a CPU program that was compiled without optimisation and runs on one thread. "
        "Here, -O3 alone makes that program {} times faster, and all threads of this machine another {} times: "
        "together "
        "{} times, without changing a line of it. That part of any factor over the paper's program is due to the "
        "baseline.",
        short_factor(rows.naive_o0, rows.naive_o3), short_factor(rows.naive_o3, rows.naive_o3_threads),
        short_factor(rows.naive_o0, rows.naive_o3_threads))});
    if (m.has_naive_gpu) {
        const double share = 1 - middle(rows.naive_gpu_kernel) / middle(rows.naive_gpu_frame);
        blocks.emplace_back(
            Paragraph{fmt::format("The paper's own GPU frame, with its allocation, copy and text, is {} times as fast "
                                  "as the paper's CPU program "
                                  "(the paper says 139, and its times give {}). Against the same source with -O3 on "
                                  "all threads it is {} times as "
                                  "fast, and its kernel alone {} times: that part is due to the GPU. {} of that frame "
                                  "is spent outside the kernel (in the paper {}).",
                                  short_factor(rows.naive_o0, rows.naive_gpu_frame), format_number(paper::factor),
                                  short_factor(rows.naive_o3_threads, rows.naive_gpu_frame),
                                  short_factor(rows.naive_o3_threads, rows.naive_gpu_kernel), format_share(share),
                                  format_share(paper::share_outside_kernel))});
    }
    if (m.has_cpu && m.has_gpu) {
        blocks.emplace_back(Paragraph{fmt::format(
            "Tandem renders the same image, bit for bit, on both processors. Its kernel is {} times as fast as its own "
            "CPU "
            "renderer on all threads; from the scene to the film in host memory the GPU is {} times as fast as the CPU "
            "renderer. Quote this factor for this machine: only the processor differs.",
            times_faster(rows.cpu, rows.gpu), short_factor(rows.cpu, rows.whole))});
    }
    if (!m.has_gpu) {
        blocks.emplace_back(
            Callout{Callout::Kind::note,
                    "No GPU took part: this page shows the effect of the baseline, not the speed of a GPU."});
    }
}

/// The median over the frames of one figure of their differences.
double median_of(const ResidualSeries& series, double FilmDifference::*figure) {
    std::vector<double> values;
    for (const FilmDifference& difference : series.differences) values.push_back(difference.*figure);
    return median(values);
}

/// The rasteriser, the rung below ray tracing: docs/paper.md, row 20.
void explain_rasteriser(PaperMeasurements& m, Report& report) {
    PaperRows& rows = m.rows;
    if (rows.rasterised.seconds.empty() || m.rasterised.differences.empty()) return;
    report.blocks.emplace_back(Heading{"Without rays"});
    const std::string tandem = m.has_cpu ? fmt::format(" Tandem's CPU renderer is {} times as fast as the rasteriser.",
                                                       times_faster(rows.rasterised, rows.cpu))
                                         : "";
    report.blocks.emplace_back(Paragraph{fmt::format(
        "The paper names rasterisation as the fast, less realistic choice. A plain rasteriser on all threads "
        "(triangles "
        "and a z-buffer, the same samples per pixel, -O3) is {} times as fast as the paper's method with -O3 on all "
        "threads.{} Its images differ from Tandem's by {} on average (root mean square {}), two of Tandem's with "
        "different seeds by {} ({}). It has what this scene needs: first hits, and direct light without shadows. It "
        "has "
        "no shadows, reflection, refraction, indirect light or textures, and its spheres are made of triangles: "
        "tandem-bench accuracy measures what that costs in scenes that need them.",
        times_faster(rows.naive_o3_threads, rows.rasterised), tandem,
        format_number(median_of(m.rasterised, &FilmDifference::mean)),
        format_number(median_of(m.rasterised, &FilmDifference::rms)),
        format_number(median_of(m.noise, &FilmDifference::mean)),
        format_number(median_of(m.noise, &FilmDifference::rms)))});
}

/// A table of the figures that the paper prints, those that follow from its numbers, and those measured here.
Table beside_the_paper(const PaperMeasurements& m) {
    const PaperRows& rows = m.rows;
    const auto measured = [](bool there, auto text) { return there ? text() : std::string("no GPU here"); };
    const auto median_rate = [](const ResidualSeries& series, Tolerance tolerance) {
        std::vector<double> rates;
        for (const FilmDifference& difference : series.differences)
            rates.push_back(difference.residual_rate(tolerance));
        return format_share(median(rates));
    };
    Table table{"The paper used another machine: compare ratios, not times",
                {{"Figure"}, {"Printed in the paper"}, {"From its numbers"}, {"Measured here, with its method"}},
                {}};
    table.rows.push_back({"CPU time per frame", "35,329.4 ms", "", format_seconds(middle(rows.naive_o0))});
    table.rows.push_back({"GPU time per frame", "225.6 ms", "",
                          measured(m.has_naive_gpu, [&] { return format_seconds(middle(rows.naive_gpu_frame)); })});
    table.rows.push_back({"Kernel time", "4.72 ms", "",
                          measured(m.has_naive_gpu, [&] { return format_seconds(middle(rows.naive_gpu_kernel)); })});
    table.rows.push_back({"Frames per second of the kernel", "12,711",
                          fmt::format("{}; 12,711 is per minute ({})", format_number(paper::frames_per_second),
                                      format_number(paper::frames_per_minute)),
                          measured(m.has_naive_gpu, [&] { return format_number(1 / middle(rows.naive_gpu_kernel)); })});
    table.rows.push_back(
        {"GPU over CPU, whole frame", "at least 139 times", format_number(paper::factor) + " times",
         measured(m.has_naive_gpu, [&] { return times_faster(rows.naive_o0, rows.naive_gpu_frame) + " times"; })});
    table.rows.push_back({"GPU frame spent outside the kernel", "", format_share(paper::share_outside_kernel),
                          measured(m.has_naive_gpu, [&] {
                              return format_share(1 - middle(rows.naive_gpu_kernel) / middle(rows.naive_gpu_frame));
                          })});
    table.rows.push_back(
        {"Residual: pixels that differ", "5 %", "noise and arithmetic mixed: two random sequences",
         fmt::format("{} differ at all, {} by more than 1/255, {} by more than 5 %",
                     median_rate(m.naive_paper, Tolerance::bits), median_rate(m.naive_paper, Tolerance::one_level),
                     median_rate(m.naive_paper, Tolerance::relative_5_percent))});
    return table;
}

Table residual_table(const PaperMeasurements& m) {
    Table table{"Share of pixels that differ by more than a tolerance, median over the frames", {{"Compared"}}, {}};
    for (const Tolerance tolerance : tolerances) table.columns.push_back({to_string(tolerance), true});
    for (const ResidualSeries* series : {&m.cpu_gpu, &m.naive_arithmetic, &m.noise, &m.naive_paper, &m.rasterised}) {
        if (series->differences.empty()) continue;
        std::vector<std::string> cells = {series->label};
        for (const Tolerance tolerance : tolerances) {
            std::vector<double> rates;
            for (const FilmDifference& difference : series->differences) {
                rates.push_back(difference.residual_rate(tolerance));
            }
            cells.push_back(format_share(median(rates)));
        }
        table.rows.push_back(std::move(cells));
    }
    return table;
}

Table phase_table(const PaperRows& rows) {
    Table table{"Medians", {{"Row"}, {"Phase"}, {"Time", true}, {"Share of the row", true}}, {}};
    for (const BenchmarkRow* row : {&rows.naive_gpu_frame, &rows.whole, &rows.text, &rows.png}) {
        for (const PhaseTimings& timings : row->phases) {
            const double seconds = median(timings.seconds);
            if (timings.name == "frame" || seconds == 0) continue;
            table.rows.push_back(
                {row->label, timings.name, format_seconds(seconds), format_share(seconds / middle(*row))});
        }
    }
    return table;
}

Table kernel_table(const PaperRows& rows) {
    Table table{"", {{"Kernel"}, {"Code"}, {"Registers", true}, {"Occupancy", true}, {"Rays/s", true}}, {}};
    for (const BenchmarkRow* row : {&rows.cpu, &rows.gpu}) {
        if (row->seconds.empty()) continue;
        table.rows.push_back({row->label, row->variant, row->registers == 0 ? "" : fmt::format("{}", row->registers),
                              row->occupancy == 0 ? "" : format_share(row->occupancy),
                              row->rays == 0 ? "" : format_count(rays_per_second(*row))});
    }
    return table;
}

void report_sequences(const PaperMeasurements& m, Report& report) {
    report.blocks.emplace_back(Heading{"The whole animation"});
    Table table{
        "Several frames are in flight and other threads write the files; wall-clock time from the first frame to the "
        "last file",
        {{"Output"}, {"Frames", true}, {"Wall", true}, {"Rendering", true}, {"Share", true}, {"Frames/s", true}},
        {}};
    for (const PaperSequence& sequence : m.sequences) {
        const SequenceTimes& t = sequence.times;
        table.rows.push_back({sequence.label, fmt::format("{}", t.frames), format_seconds(t.wall),
                              format_seconds(t.render), format_share(t.render_share()),
                              format_number(t.frames / t.wall)});
    }
    report.blocks.emplace_back(std::move(table));
    for (const PaperSequence& sequence : m.sequences) {
        report.counters += sequence.times.counters;
        const bool enough = sequence.times.render_share() >= least_render_share;
        report.blocks.emplace_back(Callout{enough ? Callout::Kind::good : Callout::Kind::note,
                                           fmt::format("{}: {}", sequence.label, describe_bottleneck(sequence.times))});
        report.properties.emplace_back("render share, " + sequence.label,
                                       fmt::format("{}", sequence.times.render_share()));
    }
}

void report_equality(const PaperMeasurements& m, Report& report) {
    if (m.cpu_gpu.differences.empty()) return;
    std::size_t pixels = 0, differing = 0;
    for (const FilmDifference& difference : m.cpu_gpu.differences) {
        pixels += difference.pixels;
        differing += difference.differing_sums;
    }
    report.properties.emplace_back("pixels that differ between CPU and GPU", fmt::format("{}", differing));
    report.properties.emplace_back("pixels compared", fmt::format("{}", pixels));
    report.blocks.emplace_back(Callout{
        differing == 0 ? Callout::Kind::good : Callout::Kind::bad,
        fmt::format("{} of {} pixels differ in any bit of their sums between Tandem's CPU and GPU.",
                    format_number(static_cast<double>(differing)), format_number(static_cast<double>(pixels)))});
}

constexpr const char* how_measured =
    "All rows take turns on the same frames, in alternating order, so that drift of the machine affects all alike. "
    "Rows "
    "of the paper's method are a plain reimplementation, compiled with the flags that the row names. Its CPU rows time "
    "rendering only, its GPU frame what the paper timed: allocation, random states, kernel, copy, text. Tandem's rows "
    "time the kernel or the loop over tiles, then everything from the scene to the film in host memory, then a file as "
    "well, one after the other. A slow row measures fewer frames; no time is extrapolated.";

}  // namespace

void report_paper(PaperMeasurements m, const PaperOptions& options, Report& report) {
    report.title = "The paper's speed-up, audited";
    report.summary = fmt::format(
        "The paper's scene, frames {} to {}, {} x {} pixels, {} samples per pixel: by the paper's method on CPU and "
        "GPU, "
        "and by Tandem on both.",
        options.frames.first, options.frames.last, options.size.width, options.size.height, options.samples);
    auto& blocks = report.blocks;
    report_equality(m, report);
    blocks.emplace_back(Heading{"Time per frame"});
    blocks.emplace_back(ladder_table(m.rows));
    explain_factor(m, report);
    explain_rasteriser(m, report);
    blocks.emplace_back(Heading{"Comparison with the paper's numbers"});
    blocks.emplace_back(beside_the_paper(m));
    blocks.emplace_back(Heading{"Time per frame (after the paper's figures 4, 6 and 7)"});
    add_time_plots(m, report);
    blocks.emplace_back(Heading{"Throughput (after the paper's figures 8 and 9)"});
    add_throughput_plot(m.rows, report);
    blocks.emplace_back(kernel_table(m.rows));
    blocks.emplace_back(phase_table(m.rows));
    blocks.emplace_back(Heading{"Residual (after the paper's figure 10)"});
    blocks.emplace_back(
        Paragraph{"The paper calls the share of differing pixels the residual. A single tolerance can be chosen to "
                  "flatter, so here are several. Two random sequences always differ by noise; only with the same "
                  "random numbers does a difference show the arithmetic."});
    blocks.emplace_back(residual_table(m));
    add_residual_plots(m, report);
    report_sequences(m, report);
    blocks.emplace_back(Heading{"Pictures"});
    blocks.emplace_back(
        Paragraph{fmt::format("All {} frames are in {}/frames, at full size.", options.frames.count(), options.out)});
    blocks.emplace_back(PictureGrid{std::move(m.pictures)});
    blocks.emplace_back(Heading{"How it was measured"});
    blocks.emplace_back(Paragraph{how_measured});
    for (BenchmarkRow* row : m.rows.all()) {
        if (row->seconds.empty()) continue;
        if (row != &m.rows.naive_o0) row->factor = factor_over(m.rows.naive_o0, *row);
        report.rows.push_back(*row);
    }
    for (std::size_t i = 0; i < m.film_hashes.size(); ++i) {
        report.properties.emplace_back(fmt::format("film frame {}", options.frames.first + static_cast<int>(i)),
                                       m.film_hashes[i]);
    }
}

bool run_paper(const PaperOptions& options, const BackendSource& source, Report& report) {
    PaperMeasurements measurements = measure_paper(options, source, report);
    const bool equal = std::all_of(measurements.cpu_gpu.differences.begin(), measurements.cpu_gpu.differences.end(),
                                   [](const FilmDifference& difference) { return difference.differing_sums == 0; });
    report_paper(std::move(measurements), options, report);
    return equal;
}

}  // namespace tandem::bench
