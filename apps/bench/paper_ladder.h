/// The measurements of tandem-bench paper: the paper's method and Tandem, on the CPU and on the GPU, frame by frame.
#pragma once

#include <string>
#include <vector>

#include "backend_source.h"
#include "common/arguments.h"
#include "sequence.h"
#include "tandem/images/compare.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct PaperOptions {
    std::string out = "out/paper";  ///< folder for images and report
    FrameRange frames{0, 119};
    FilmSize size{1000, 900};
    int samples = 100;
    std::uint64_t seed = 0;
    /// Frames that the unoptimised program renders; three times as many for -O3 on one thread. 0 means 3 with a GPU and
    /// 1 without.
    int slow_frames = 0;
    int threads = 0;  ///< of the CPU; 0 means one per core
    std::vector<std::string> backends = {"cpu", "cuda"};
};

/// Rows of one frame each, in the order of the page. Rows that this machine cannot measure have no seconds.
struct PaperRows {
    BenchmarkRow naive_o0;          ///< the paper's CPU program: no optimisation, one thread
    BenchmarkRow naive_o3;          ///< the same source with -O3
    BenchmarkRow naive_o3_threads;  ///< and on all threads
    BenchmarkRow rasterised;        ///< no rays: a plain rasteriser on all threads
    BenchmarkRow naive_gpu_kernel;  ///< the paper's kernel alone
    BenchmarkRow naive_gpu_frame;   ///< with allocation, copy and text, as the paper timed it
    BenchmarkRow cpu;               ///< Tandem, rendering alone
    BenchmarkRow gpu;               ///< Tandem, kernel alone
    BenchmarkRow whole;             ///< Tandem from the scene to the film on the host: on the best backend here
    BenchmarkRow text;              ///< and a P3 file
    BenchmarkRow png;               ///< a PNG file instead

    [[nodiscard]] std::vector<BenchmarkRow*> all();
};

/// The pixels that differ between two renderings, frame by frame.
struct ResidualSeries {
    std::string label;
    std::vector<std::int32_t> frames;
    std::vector<FilmDifference> differences;
};

struct PaperSequence {
    std::string label;
    SequenceTimes times;
};

struct PaperMeasurements {
    PaperRows rows;
    bool has_cpu = false;
    bool has_gpu = false;                  ///< Tandem's CUDA backend ran
    bool has_naive_gpu = false;            ///< the paper's kernel ran
    std::string output_backend;            ///< of the rows `whole`, `text`, `png` and of the sequences
    ResidualSeries cpu_gpu;                ///< Tandem, CPU against GPU
    ResidualSeries noise;                  ///< Tandem, one seed against another
    ResidualSeries naive_arithmetic;       ///< naive, CPU against GPU, the same random numbers
    ResidualSeries naive_paper;            ///< naive, different random numbers: as the paper compared
    ResidualSeries rasterised;             ///< the rasteriser against Tandem
    std::vector<std::string> film_hashes;  ///< of Tandem's films, by frame
    std::vector<PaperSequence> sequences;
    std::vector<Picture> pictures;
};

/// `count` evenly spaced frames of `range`, from its first; all of them if it has no more.
[[nodiscard]] std::vector<std::int32_t> spread_frames(const FrameRange& range, int count);

/// Measures; writes frames/frame-0000.png and so on into the folder. Notes on what is missing go into `report`.
[[nodiscard]] PaperMeasurements measure_paper(const PaperOptions& options, const BackendSource& source, Report& report);

}  // namespace tandem::bench
