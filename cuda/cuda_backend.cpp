#include "cuda/cuda_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>

#include "cuda/device_scene.h"
#include "cuda/film_memory.h"
#include "cuda/level_kernels.h"
#include "cuda/plane_kernels.h"
#include "cuda/scene_kernels.h"
#include "tandem/base/error.h"
#include "tandem/compile/derive.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/film/plane_names.h"
#include "tandem/images/tone_curve.h"
#include "tandem/kernel/first_hit.h"
#include "tandem/math/fp_environment.h"
#include "tandem/render/combined_backend.h"
#include "tandem/render/complete_planes.h"
#include "tandem/render/pixel_job.h"
#include "tandem/render/ray_coherence.h"
#include "tandem/render/traced_job.h"

namespace tandem {

namespace {

using namespace cuda;

/// Memory and events of one frame in flight.
struct FrameMemory {
    Buffer<DeviceMemory> film;
    Buffer<DeviceMemory> one_sample;  ///< one sample of each pixel, if squares of samples are added
    Buffer<DeviceMemory> radiances;   ///< of samples that are not in the film yet
    Buffer<DeviceMemory> levels;      ///< of 8 bits, if they are asked for
    Buffer<DeviceMemory> counters;
    Buffer<PinnedMemory> counters_on_host;
    Event render_start, render_end, download_start, download_end;
};

using FilmPool = Pool<Buffer<FilmMemory>>;

/// Memory from the pool for a film or its levels; the pointer keeps the lease.
template <class T>
std::shared_ptr<T> film_memory(FilmPool& pool, std::size_t bytes) {
    auto buffer = pool.lease();
    buffer->reserve(bytes);
    auto* start = reinterpret_cast<T*>(buffer->data());
    return {std::move(buffer), start};
}

DeviceCounters read(const Buffer<PinnedMemory>& buffer) {
    DeviceCounters counters;
    std::memcpy(&counters, buffer.data(), sizeof(counters));
    return counters;
}

RenderCounters to_render_counters(const DeviceCounters& counters) {
    RenderCounters result;
    result.invalid_samples = counters.invalid_samples;
    result.lost_media = counters.lost_media;
    result.rejected_rays = counters.rejected_rays;
    result.stack_overflows = counters.stack_overflows;
    return result;
}

/// Where the pixels of a frame go: a window of a film.
struct FilmPlace {
    Film film;
    FilmWindow window;
    bool is_own = true;  ///< the film is that of the result
};

/// A frame that the GPU has begun, until all of it is on the host.
class Begun {
  public:
    Begun(std::shared_ptr<ResidentScene> scene, std::shared_ptr<FrameMemory> memory, RenderStats stats)
        : scene_(std::move(scene)), memory_(std::move(memory)), stats_(std::move(stats)) {}
    Begun(Begun&&) = default;
    Begun& operator=(Begun&&) = delete;
    /// Waits for the GPU, which may still be writing, before the memory returns to its pool.
    ~Begun() {
        if (!memory_) return;
        (void)cudaEventSynchronize(memory_->render_end.get());  // after an error nothing else may be queued
        (void)cudaEventSynchronize(memory_->download_end.get());
    }

    [[nodiscard]] FrameMemory& memory() const { return *memory_; }
    [[nodiscard]] const DeviceScene& scene() const { return dynamic_cast<const DeviceScene&>(*scene_); }
    [[nodiscard]] RenderStats& stats() { return stats_; }

    /// Waits, and completes the statistics.
    void wait() {
        memory_->download_end.wait();
        stats_.seconds.render = seconds_between(memory_->render_start, memory_->render_end);
        stats_.seconds.download = seconds_between(memory_->download_start, memory_->download_end);
        const DeviceCounters counters = read(memory_->counters_on_host);
        stats_.counters += to_render_counters(counters);
        if (stats_.effects.has_any(counted_ray_effects)) {
            for (const auto rays : counters.rays) stats_.rays += rays;
        }
    }

  private:
    std::shared_ptr<ResidentScene> scene_;  // its memory is being read
    std::shared_ptr<FrameMemory> memory_;
    RenderStats stats_;
};

class CudaFrame final : public PendingFrame {
  public:
    CudaFrame(Begun begun, FilmPlace place) : place_(std::move(place)), begun_(std::move(begun)) {}

    RenderResult get() override {
        begun_.wait();
        complete_planes(place_.film, place_.window, begun_.scene().copies());
        return {place_.is_own ? std::move(place_.film) : Film(), std::move(begun_.stats())};
    }

  private:
    FilmPlace place_;
    Begun begun_;  // the last: it waits for the GPU before the film's memory returns to its pool
};

class CudaImage final : public PendingImage {
  public:
    CudaImage(Begun begun, std::shared_ptr<const std::byte> memory, int width, int height)
        : memory_(std::move(memory)), width_(width), height_(height), begun_(std::move(begun)) {}

    ImageResult get() override {
        begun_.wait();
        const LevelLayout layout{3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)};
        unsigned long long nan_values = 0;
        std::memcpy(&nan_values, memory_.get() + layout.nan_values(), sizeof(nan_values));
        const auto* levels = reinterpret_cast<const std::uint8_t*>(memory_.get());
        return {{width_, height_, {levels, layout.values}}, std::move(memory_), nan_values, std::move(begun_.stats())};
    }

  private:
    std::shared_ptr<const std::byte> memory_;
    int width_, height_;
    Begun begun_;  // the last, as above
};

class CudaBackend final : public Backend {
  public:
    /// On GPU number `gpu`.
    CudaBackend(const BackendOptions& options, int gpu)
        : gpu_(selected(gpu)),
          specialise_(options.specialise),
          culls_pixels_(options.culls_pixels),
          refits_(options.refits_hierarchies) {
        check(cudaGetDeviceProperties(&properties_, gpu_), "reading the properties of the GPU");
        kernels_.emplace(properties_.major * 10 + properties_.minor);
    }

    /// Waits for all work before the streams are destroyed.
    ~CudaBackend() override {
        (void)cudaSetDevice(gpu_);
        (void)cudaDeviceSynchronize();
    }

    [[nodiscard]] std::string name() const override { return "cuda"; }

    [[nodiscard]] Capabilities capabilities() const override {
        int driver = 0;
        int runtime = 0;
        check(cudaDriverGetVersion(&driver), "reading the driver's version");
        check(cudaRuntimeGetVersion(&runtime), "reading the runtime's version");
        const auto version = [](int v) { return fmt::format("{}.{}", v / 1000, v % 1000 / 10); };
        return {.device = fmt::format("{}, {} multiprocessors, compute capability {}.{}{}", properties_.name,
                                      properties_.multiProcessorCount, properties_.major, properties_.minor,
                                      gpu_ == 0 ? "" : fmt::format(", GPU {}", gpu_)),
                .description = fmt::format("CUDA {}, driver for CUDA {}", version(runtime), version(driver)),
                .exact = true};
    }

    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier) override {
        const DefaultFpEnvironment guard;
        (void)selected(gpu_);
        if (scene.copies.empty()) return std::make_shared<DeviceScene>(scene, tier, scenes_->lease(), upload_, refits_);
        auto result = std::make_shared<DeviceScene>(without_copies(scene), tier, scenes_->lease(), upload_, refits_);
        result->set_copies(scene.copies);
        return result;
    }

    double trace(ResidentScene& scene, const TraceJob& job) override {
        const DefaultFpEnvironment guard;
        (void)selected(gpu_);
        check(job);
        const auto& resident = dynamic_cast<const DeviceScene&>(scene);
        return trace_without_copies(resident.copies(), job,
                                    [&](const TraceJob& traced) { return trace(resident, traced); });
    }

    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                       const RenderJob& job) override {
        const DefaultFpEnvironment guard;
        check(job, scene->tier());
        const FilmWindow window = window_of(job);
        Film film = make_film(window.width, window.height, job.samples, job.planes);
        return start(std::move(scene), job, {std::move(film), {0, 0, window.width, window.height}}, compute());
    }

    [[nodiscard]] std::unique_ptr<PendingImage> submit_image(std::shared_ptr<ResidentScene> scene, const RenderJob& job,
                                                             const Display& display) override {
        const DefaultFpEnvironment guard;
        check(job, scene->tier());
        check_image(job);
        Begun begun = begin(std::move(scene), job, compute());
        FrameMemory& memory = begun.memory();
        const FilmWindow window = window_of(job);
        const std::size_t pixels = pixels_of(window);
        const LevelLayout layout{3 * pixels};
        memory.levels.reserve(layout.bytes());
        auto on_host = film_memory<std::byte>(*images_, layout.bytes());
        const LevelRule rule{static_cast<double>(job.samples), exposure_factor(display), entries_of(display.transfer)};
        begin_download(memory);
        find_levels(reinterpret_cast<const Vec3d*>(memory.film.data()), pixels, rule, memory.levels.data(),
                    download_.get());
        check(cudaMemcpyAsync(on_host.get(), memory.levels.data(), layout.bytes(), cudaMemcpyDeviceToHost,
                              download_.get()),
              "downloading an image");
        end_download(memory);
        begun.stats().device_bytes += layout.bytes();
        return std::make_unique<CudaImage>(std::move(begun), std::move(on_host), window.width, window.height);
    }

    /// Frames for parts of a film alternate between two streams: when the last pixels of one leave multiprocessors
    /// idle, the next one already runs there.
    [[nodiscard]] std::unique_ptr<PendingFrame> submit_to(Film film, int left, int top,
                                                          std::shared_ptr<ResidentScene> scene,
                                                          const RenderJob& job) override {
        const DefaultFpEnvironment guard;
        check(job, scene->tier());
        const FilmWindow window = window_of(job);
        if (left < 0 || top < 0 || window.width > film.width() - left || window.height > film.height() - top ||
            film.plane_mask() != job.planes) {
            throw InputError(
                fmt::format("a window of {} x {} pixels at ({}, {}) with the planes '{}' does not fit a "
                            "film of {} x {} with '{}'",
                            window.width, window.height, left, top, to_string(job.planes), film.width(), film.height(),
                            to_string(film.plane_mask())));
        }
        turn_ = (turn_ + 1) % computes_.size();
        FilmPlace place{std::move(film), {left, top, window.width, window.height}, false};
        return start(std::move(scene), job, std::move(place), computes_[turn_]);
    }

    [[nodiscard]] Film make_film(int width, int height, int samples, PlaneMask planes) override {
        (void)selected(gpu_);
        const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        return {width, height, samples, film_memory<Vec3d>(*films_, film_bytes(pixels, planes)), planes};
    }

  private:
    /// Starts a frame on a stream, and the download of its film to its place.
    [[nodiscard]] std::unique_ptr<PendingFrame> start(std::shared_ptr<ResidentScene> scene, const RenderJob& job,
                                                      FilmPlace place, Stream& compute) {
        Begun begun = begin(std::move(scene), job, compute, place.is_own ? 0 : pixels_of_parts(place.film));
        FrameMemory& memory = begun.memory();
        begin_download(memory);
        download_film(reinterpret_cast<Vec3d*>(memory.film.data()), pixels_of(window_of(job)), place);
        end_download(memory);
        return std::make_unique<CudaFrame>(std::move(begun), std::move(place));
    }

    /// A frame for a part of the film reserves memory for at least this many pixels: a quarter of the film, up to a
    /// limit. With less, a frame larger than all before it would have to wait, because memory is not freed before the
    /// GPU has done all its work.
    static std::size_t pixels_of_parts(const Film& film) {
        constexpr std::size_t most = std::size_t{1} << 23;
        return std::min(film.pixel_count() / 4, most);
    }
    static std::size_t pixels_of(const FilmWindow& window) {
        return static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
    }

    /// Downloads that are queued from now on start after the frame's kernels.
    void begin_download(FrameMemory& memory) {
        download_.wait_for(memory.render_end);
        memory.download_start.record(download_.get());
    }
    void end_download(FrameMemory& memory) {
        check(cudaMemcpyAsync(memory.counters_on_host.data(), memory.counters.data(), sizeof(DeviceCounters),
                              cudaMemcpyDeviceToHost, download_.get()),
              "downloading counters");
        memory.download_end.record(download_.get());
    }

    /// Starts the kernels of a frame on a stream. `least_pixels`: reserves memory for at least this many.
    [[nodiscard]] Begun begin(std::shared_ptr<ResidentScene> scene, const RenderJob& job, Stream& compute,
                              std::size_t least_pixels = 0) {
        (void)selected(gpu_);
        const auto& resident = dynamic_cast<const DeviceScene&>(*scene);
        const PixelJob pixel_job = make_pixel_job(resident.camera(), job);
        const FilmWindow window = window_of(job);
        const std::size_t pixels = pixels_of(window);
        const std::size_t reserved = std::max(pixels, least_pixels);
        const std::size_t bytes = film_bytes(reserved, job.planes);
        const std::size_t sample_bytes = job.planes.has(FilmPlane::variance) ? reserved * sizeof(Vec3d) : 0;
        constexpr std::size_t counter_bytes = sizeof(DeviceCounters);

        // Reserve memory
        auto memory = frames_->lease();
        memory->film.reserve(bytes);
        memory->one_sample.reserve(sample_bytes);
        memory->counters.reserve(counter_bytes);
        memory->counters_on_host.reserve(counter_bytes);

        // Select the kernel: linked for the scene, or compiled ahead of time
        const EffectMask effects = resident.effects();
        const std::size_t variant = variant_for(variants, effects);
        SceneKernels::Found linked;
        if (specialise_ == Specialise::always) {
            LinkedFacts facts = linked_facts(resident.view().scene, effects, job.limits, job.sampler, job.filter);
            const Structure structure = structure_of(resident.view());
            if (structure == Structure::instanced) facts.kinds |= PrimitiveKinds::instanced;
            if (renders_in_stages(job.tier, structure, facts, resident.view().scene, pixel_job.width,
                                  static_cast<std::uint32_t>(window.height))) {
                facts.in_stages = 1;
            }
            linked = kernels_->find(job.tier, resident.view(), facts);
        }
        const SceneKernel& kernel =
            linked.kernel != nullptr ? *linked.kernel : kernels_->compiled(job.tier, resident.view(), variant);
        const std::size_t waiting_bytes = radiance_bytes(kernel, resident.view());
        memory->radiances.reserve(waiting_bytes);
        compute.wait_for(resident.uploaded());
        memory->render_start.record(compute.get());
        check(cudaMemsetAsync(memory->counters.data(), 0, counter_bytes, compute.get()), "clearing counters");
        auto* device_sums = reinterpret_cast<Vec3d*>(memory->film.data());
        auto* counters = reinterpret_cast<DeviceCounters*>(memory->counters.data());
        const auto height = static_cast<std::uint32_t>(window.height);
        const FilmPlanes planes = planes_in(device_sums, pixels, job.planes);
        const auto draw = [&](const PixelJob& samples, Vec3d* sums) {
            launch_render(kernel, resident.view(), samples, height, culls_pixels_, sums, memory->radiances.data(),
                          counters, compute.get());
        };
        if (planes.variance != nullptr) {
            draw_one_by_one(pixel_job, draw, *memory, pixels, planes.variance, compute.get());
        } else {
            draw(pixel_job, device_sums);
        }
        if (job.planes.has_any(first_hit_planes)) {
            first_hits(structure_of(resident.view()), job.tier)(resident.view(), first_hit_job(pixel_job, job.planes),
                                                                height, planes, counters, compute.get());
        }
        memory->render_end.record(compute.get());

        const KernelFacts facts = facts_of(kernel.code.function());
        RenderStats stats;
        if (!effects.has_any(counted_ray_effects)) stats.rays = pixels * pixel_job.samples;
        stats.counters.dropped_primitives = resident.dropped_primitives();
        stats.counters.dropped_lights = resident.dropped_lights();
        stats.device_bytes = resident.bytes() + bytes + sample_bytes + waiting_bytes;
        stats.registers = facts.registers;
        stats.occupancy = facts.occupancy;
        static constexpr const char* structure_names[] = {"few", "loop", "bvh", "instances"};
        stats.effects = effects;
        if (linked.kernel == nullptr) stats.carried = variants[variant].effects - effects - host_effects;
        stats.seconds.compile = linked.seconds;
        stats.warning = std::move(linked.warning);
        stats.variant = fmt::format("sm_{}{}, {}, {}", properties_.major, properties_.minor,
                                    structure_names[static_cast<int>(structure_of(resident.view()))],
                                    linked.kernel != nullptr ? "for the scene" : variants[variant].name);
        return {std::move(scene), std::move(memory), std::move(stats)};
    }

    /// kernel_facts(), asked for once, not for every band of a frame.
    KernelFacts facts_of(const void* kernel) {
        const auto place = facts_.find(kernel);
        return place != facts_.end() ? place->second : facts_.emplace(kernel, kernel_facts(kernel)).first->second;
    }

    /// The table of levels, uploaded by the first call; null for linear levels, which need none.
    const std::uint32_t* entries_of(TransferFunction transfer) {
        if (transfer == TransferFunction::linear) return nullptr;
        if (level_entries_.capacity() == 0) {
            const SrgbLevels::Entries& entries = srgb_level_entries();
            level_entries_.reserve(sizeof(entries));
            check(cudaMemcpy(level_entries_.data(), entries.data(), sizeof(entries), cudaMemcpyHostToDevice),
                  "uploading the levels of sRGB");
        }
        return reinterpret_cast<const std::uint32_t*>(level_entries_.data());
    }

    /// Starts the download of sums and planes. A whole film is one copy, and so is each plane of whole rows.
    void download_film(Vec3d* sums, std::size_t pixels, FilmPlace& place) {
        const FilmWindow& window = place.window;
        Film& film = place.film;
        if (pixels == film.pixel_count()) {
            check(cudaMemcpyAsync(film.sums().data(), sums, film_bytes(pixels, film.plane_mask()),
                                  cudaMemcpyDeviceToHost, download_.get()),
                  "downloading the film");
            return;
        }
        const auto width = static_cast<std::size_t>(window.width), film_width = static_cast<std::size_t>(film.width());
        const std::size_t first =
            static_cast<std::size_t>(window.top) * film_width + static_cast<std::size_t>(window.left);
        const auto copy = [&](auto* to, const auto* from) {
            if (width == film_width) {
                check(cudaMemcpyAsync(to + first, from, pixels * sizeof(*to), cudaMemcpyDeviceToHost, download_.get()),
                      "downloading rows of the film");
                return;
            }
            check(cudaMemcpy2DAsync(to + first, film_width * sizeof(*to), from, width * sizeof(*from),
                                    width * sizeof(*from), static_cast<std::size_t>(window.height),
                                    cudaMemcpyDeviceToHost, download_.get()),
                  "downloading a part of the film");
        };
        const FilmPlanes to = film.planes(), from = planes_in(sums, pixels, film.plane_mask());
        copy(film.sums().data(), sums);
#define TANDEM_PLANE(name, Value, rule, channels, help) \
    if (to.name != nullptr) copy(to.name, from.name);
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
    }

    /// Starts the samples one by one, so that their squares can be added; draw(job, film) starts those of a job. The
    /// sums have the same bits as from one kernel for all samples.
    template <class Draw>
    static void draw_one_by_one(const PixelJob& job, Draw draw, const FrameMemory& memory, std::size_t pixels,
                                Vec3d* squares, cudaStream_t stream) {
        auto* sums = reinterpret_cast<Vec3d*>(memory.film.data());
        auto* sample = reinterpret_cast<Vec3d*>(memory.one_sample.data());
        for (Vec3d* zeros : {sums, squares}) {
            check(cudaMemsetAsync(zeros, 0, pixels * sizeof(Vec3d), stream), "clearing sums");
        }
        PixelJob one = job;
        one.samples = 1;
        for (std::uint32_t i = 0; i < job.samples; ++i) {
            one.first_sample = job.first_sample + i;
            constexpr std::size_t queue = offsetof(DeviceCounters, next_in_queue);
            check(cudaMemsetAsync(memory.counters.data() + queue, 0, sizeof(DeviceCounters) - queue, stream),
                  "resetting the queue of pixels");
            draw(one, sample);
            add_samples(sample, sums, squares, pixels, stream);
        }
    }

    double trace(const DeviceScene& resident, const TraceJob& job) {
        const DeviceSceneView& view = resident.view();
        const Structure structure = structure_of(view);
        const float size =
            reach((structure == Structure::instanced ? view.instanced_bvh.frame : view.bvh.frame).bounds);
        const bool coherent =
            job.coherence == Coherence::unknown ? are_coherent(job.rays, size) : job.coherence == Coherence::coherent;
        const std::uint32_t row = row_length(job.rays, size);
        if (may_refill(resident.view(), coherent)) candidates_.reserve(job.rays.size() * candidate_bytes);
        const cudaStream_t stream = compute().get();
        hits_.reserve(job.hits.size_bytes());
        wide_t_.reserve(job.wide_t.size_bytes());
        counters_.reserve(sizeof(DeviceCounters));
        counters_on_host_.reserve(sizeof(DeviceCounters));
        compute().wait_for(resident.uploaded());
        const DeviceRays rays = {.rays = upload(job.rays, rays_),
                                 .sources = upload(job.sources, sources_),
                                 .ends = upload(job.ends, ends_),
                                 .hits = reinterpret_cast<Hit*>(hits_.data()),
                                 .wide_t = job.wide_t.empty() ? nullptr : reinterpret_cast<double*>(wide_t_.data()),
                                 .counters = reinterpret_cast<DeviceCounters*>(counters_.data()),
                                 .count = job.rays.size(),
                                 .candidates = candidates_.data(),
                                 .are_coherent = coherent,
                                 .row = row,
                                 .tiled = row == 0 ? 0 : job.rays.size() / row / 4 * 4 * row};
        check(cudaMemsetAsync(counters_.data(), 0, sizeof(DeviceCounters), stream), "clearing counters");
        trace_start_.record(stream);
        trace_kernels(structure, resident.tier(), ask_of(rays))(resident.view(), rays, stream);
        trace_end_.record(stream);
        download(job.hits, hits_);
        download(job.wide_t, wide_t_);
        check(cudaMemcpyAsync(counters_on_host_.data(), counters_.data(), sizeof(DeviceCounters),
                              cudaMemcpyDeviceToHost, stream),
              "downloading counters");
        check(cudaStreamSynchronize(stream), "tracing rays");
        if (job.counters != nullptr) *job.counters += to_render_counters(read(counters_on_host_));
        return seconds_between(trace_start_, trace_end_);
    }

    /// Makes a GPU the current one of this thread: allocations, kernels and events go there. Returns its number.
    static int selected(int gpu) {
        check(cudaSetDevice(gpu), "choosing the GPU");
        return gpu;
    }
    /// The stream of whole frames and of rays.
    Stream& compute() { return computes_.front(); }

    static void check(cudaError_t code, const char* doing) { cuda::check(code, doing); }
    static void check(const TraceJob& job) { tandem::check(job); }
    static void check(const RenderJob& job, Tier loaded_for) { tandem::check(job, loaded_for); }

    /// Starts a copy to the device and returns its address; null for an empty span.
    template <class T>
    const T* upload(std::span<const T> from, Buffer<DeviceMemory>& to) {
        if (from.empty()) return nullptr;
        to.reserve(from.size_bytes());
        check(cudaMemcpyAsync(to.data(), from.data(), from.size_bytes(), cudaMemcpyHostToDevice, compute().get()),
              "uploading rays");
        return reinterpret_cast<const T*>(to.data());
    }

    /// Starts a copy to the host.
    template <class T>
    void download(std::span<T> to, const Buffer<DeviceMemory>& from) {
        if (to.empty()) return;
        check(cudaMemcpyAsync(to.data(), from.data(), to.size_bytes(), cudaMemcpyDeviceToHost, compute().get()),
              "downloading hits");
    }

    int gpu_;  ///< CUDA's number; chosen before the members below are made there
    Specialise specialise_;
    bool culls_pixels_;
    bool refits_;
    std::optional<SceneKernels> kernels_;
    std::map<const void*, KernelFacts> facts_;  ///< by kernel
    cudaDeviceProp properties_{};
    Stream upload_;
    Stream download_{Stream::Priority::first};  ///< so that levels are found while the next frame is rendered
    std::array<Stream, 2> computes_;
    std::size_t turn_ = 0;  ///< the stream that submit_to() took last
    std::shared_ptr<Pool<SceneMemory>> scenes_ = std::make_shared<Pool<SceneMemory>>();
    std::shared_ptr<Pool<FrameMemory>> frames_ = std::make_shared<Pool<FrameMemory>>();
    std::shared_ptr<FilmPool> films_ = std::make_shared<FilmPool>(), images_ = std::make_shared<FilmPool>();
    Buffer<DeviceMemory> level_entries_;
    Buffer<DeviceMemory> rays_, sources_, ends_, candidates_, hits_, wide_t_, counters_;
    Buffer<PinnedMemory> counters_on_host_;
    Event trace_start_, trace_end_;
};

}  // namespace

std::string why_cuda_unavailable() {
    int count = 0;
    const cudaError_t code = cudaGetDeviceCount(&count);
    if (code != cudaSuccess) {
        const char* help = advice(code);
        return help != nullptr ? help : cudaGetErrorString(code);
    }
    return count > 0 ? "" : "there is no CUDA GPU";
}

std::vector<std::string> cuda_gpu_names() {
    int count = 0;
    check(cudaGetDeviceCount(&count), "counting the GPUs");
    std::vector<std::string> names;
    for (int gpu = 0; gpu < count; ++gpu) {
        cudaDeviceProp properties{};
        check(cudaGetDeviceProperties(&properties, gpu), "reading the properties of a GPU");
        names.emplace_back(properties.name);
    }
    return names;
}

std::unique_ptr<Backend> make_cuda_backend(const BackendOptions& options) {
    if (options.gpus == GpuChoice{}) return std::make_unique<CudaBackend>(options, 0);
    const std::vector<int> gpus = chosen_gpus(options.gpus, cuda_gpu_names());
    if (gpus.size() == 1) return std::make_unique<CudaBackend>(options, gpus.front());
    std::vector<CombinedMember> members;
    for (const int gpu : gpus) {
        const std::string name = fmt::format("GPU {}", gpu);
        try {
            members.push_back({name, std::make_unique<CudaBackend>(options, gpu)});
        } catch (const EnvironmentError& error) {
            throw EnvironmentError(fmt::format("{}: {}; leave it out with --gpus", name, error.what()));
        }
    }
    return make_combined_backend(std::move(members), {.report = options.report});
}

}  // namespace tandem
