#include "paper_plots.h"

#include <fmt/format.h>

#include "paper_figures.h"
#include "rate_plot.h"

namespace tandem::bench {

namespace {

constexpr double milliseconds = 1e3;

/// Rows that were not measured have no line.
void add_line(LinePlot& plot, const BenchmarkRow& row) {
    if (row.seconds.empty()) return;
    Line line{row.label, {}};
    for (std::size_t i = 0; i < row.seconds.size(); ++i) {
        line.points.push_back({static_cast<double>(row.rounds[i]), milliseconds * row.seconds[i]});
    }
    plot.lines.push_back(std::move(line));
}

LinePlot time_plot(const std::string& title) { return {title, {"frame", false}, {"ms per frame", true}, {}, {}}; }

}  // namespace

void add_time_plots(const PaperMeasurements& m, Report& report) {
    const PaperRows& rows = m.rows;
    LinePlot cpu = time_plot("CPU, time per frame (figure 4)");
    LinePlot gpu = time_plot("GPU, time per frame (figure 6)");
    LinePlot both = time_plot("CPU and GPU (figure 7)");
    for (const BenchmarkRow* row :
         {&rows.naive_o0, &rows.naive_o3, &rows.naive_o3_threads, &rows.rasterised, &rows.cpu}) {
        add_line(cpu, *row);
    }
    for (const BenchmarkRow* row : {&rows.naive_gpu_frame, &rows.naive_gpu_kernel, &rows.gpu, &rows.whole}) {
        if (row != &rows.whole || m.has_gpu) add_line(gpu, *row);
    }
    for (const BenchmarkRow* row :
         {&rows.naive_o0, &rows.naive_o3_threads, &rows.naive_gpu_frame, &rows.cpu, &rows.gpu}) {
        add_line(both, *row);
    }
    const ReferenceValue cpu_reference = {"the paper's CPU: 35,329 ms", milliseconds * paper::cpu_frame_seconds};
    const ReferenceValue gpu_reference = {"the paper's GPU frame: 226 ms", milliseconds * paper::gpu_frame_seconds};
    const ReferenceValue kernel_reference = {"the paper's kernel: 4.72 ms", milliseconds * paper::kernel_seconds};
    cpu.references = {cpu_reference};
    gpu.references = {gpu_reference, kernel_reference};
    both.references = {cpu_reference, gpu_reference};
    for (LinePlot* plot : {&cpu, &gpu, &both}) {
        if (!plot->lines.empty()) report.blocks.emplace_back(std::move(*plot));
    }
}

void add_throughput_plot(PaperRows& rows, Report& report) {
    const std::vector<BenchmarkRow*> all = rows.all();
    const std::vector<const BenchmarkRow*> shown(all.begin(), all.end());
    report.blocks.emplace_back(rate_plot("Samples per second (figure 9)", "samples/s", shown, samples_per_second));
}

void add_residual_plots(const PaperMeasurements& m, Report& report) {
    for (const Tolerance tolerance : {Tolerance::bits, Tolerance::one_level}) {
        LinePlot plot{fmt::format("Residual per frame (figure 10), tolerance: {}", to_string(tolerance)),
                      {"frame", false},
                      {"% of pixels", true},
                      {},
                      {{"the paper: 5 %", 100 * paper::residual_rate}}};
        for (const ResidualSeries* series : {&m.cpu_gpu, &m.naive_arithmetic, &m.noise, &m.naive_paper}) {
            if (series->frames.empty()) continue;
            Line line{series->label, {}};
            for (std::size_t i = 0; i < series->frames.size(); ++i) {
                line.points.push_back(
                    {static_cast<double>(series->frames[i]), 100 * series->differences[i].residual_rate(tolerance)});
            }
            plot.lines.push_back(std::move(line));
        }
        report.blocks.emplace_back(std::move(plot));
    }
}

}  // namespace tandem::bench
