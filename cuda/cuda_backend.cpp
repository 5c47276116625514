#include "cuda/cuda_backend.h"

#include <fmt/format.h>

#include <cstddef>
#include <optional>

#include "cuda/device_scene.h"
#include "cuda/film_memory.h"
#include "cuda/plane_kernels.h"
#include "cuda/scene_kernels.h"
#include "tandem/base/error.h"
#include "tandem/compile/derive.h"
#include "tandem/kernel/first_hit.h"
#include "tandem/math/fp_environment.h"
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
    Buffer<DeviceMemory> counters;
    Buffer<PinnedMemory> counters_on_host;
    Event render_start, render_end, download_start, download_end;
};

using FilmPool = Pool<Buffer<FilmMemory>>;

/// Film memory from the pool; the film's pointer keeps the lease.
std::shared_ptr<Vec3d> film_memory(FilmPool& pool, std::size_t bytes) {
    auto buffer = pool.lease();
    buffer->reserve(bytes);
    auto* sums = reinterpret_cast<Vec3d*>(buffer->data());
    return {std::move(buffer), sums};
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

class CudaFrame final : public PendingFrame {
  public:
    CudaFrame(std::shared_ptr<ResidentScene> scene, std::shared_ptr<FrameMemory> memory, RenderResult result)
        : scene_(std::move(scene)), memory_(std::move(memory)), result_(std::move(result)) {}

    /// Waits for the GPU, which may still be writing, before the memory returns to its pool.
    ~CudaFrame() override { (void)cudaEventSynchronize(memory_->download_end.get()); }

    RenderResult get() override {
        memory_->download_end.wait();
        result_.stats.seconds.render = seconds_between(memory_->render_start, memory_->render_end);
        result_.stats.seconds.download = seconds_between(memory_->download_start, memory_->download_end);
        complete_planes(result_.film, dynamic_cast<const DeviceScene&>(*scene_).copies());
        const DeviceCounters counters = read(memory_->counters_on_host);
        result_.stats.counters += to_render_counters(counters);
        if (result_.stats.effects.has_any(counted_ray_effects)) {
            for (const auto rays : counters.rays) result_.stats.rays += rays;
        }
        return std::move(result_);
    }

  private:
    std::shared_ptr<ResidentScene> scene_;  // its memory is being read
    std::shared_ptr<FrameMemory> memory_;
    RenderResult result_;
};

class CudaBackend final : public Backend {
  public:
    explicit CudaBackend(const BackendOptions& options)
        : specialise_(options.specialise), culls_pixels_(options.culls_pixels) {
        check(cudaSetDevice(0), "choosing the GPU");
        check(cudaGetDeviceProperties(&properties_, 0), "reading the properties of the GPU");
        kernels_.emplace(properties_.major * 10 + properties_.minor);
    }

    /// Waits for all work before the streams are destroyed.
    ~CudaBackend() override { (void)cudaDeviceSynchronize(); }

    [[nodiscard]] std::string name() const override { return "cuda"; }

    [[nodiscard]] Capabilities capabilities() const override {
        int driver = 0;
        int runtime = 0;
        check(cudaDriverGetVersion(&driver), "reading the driver's version");
        check(cudaRuntimeGetVersion(&runtime), "reading the runtime's version");
        const auto version = [](int v) { return fmt::format("{}.{}", v / 1000, v % 1000 / 10); };
        return {.device = fmt::format("{}, {} multiprocessors, compute capability {}.{}", properties_.name,
                                      properties_.multiProcessorCount, properties_.major, properties_.minor),
                .description = fmt::format("CUDA {}, driver for CUDA {}", version(runtime), version(driver)),
                .exact = true};
    }

    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier) override {
        const DefaultFpEnvironment guard;
        if (scene.copies.empty()) return std::make_shared<DeviceScene>(scene, tier, scenes_->lease(), upload_);
        auto result = std::make_shared<DeviceScene>(without_copies(scene), tier, scenes_->lease(), upload_);
        result->set_copies(scene.copies);
        return result;
    }

    double trace(ResidentScene& scene, const TraceJob& job) override {
        const DefaultFpEnvironment guard;
        check(job);
        const auto& resident = dynamic_cast<const DeviceScene&>(scene);
        return trace_without_copies(resident.copies(), job,
                                    [&](const TraceJob& traced) { return trace(resident, traced); });
    }

    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                       const RenderJob& job) override {
        const DefaultFpEnvironment guard;
        check(job, scene->tier());
        const auto& resident = dynamic_cast<const DeviceScene&>(*scene);
        const PixelJob pixel_job = make_pixel_job(resident.camera(), job);
        const FilmWindow window = window_of(job);
        const std::size_t pixels = static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
        const std::size_t bytes = film_bytes(pixels, job.planes);
        const std::size_t sample_bytes = job.planes.has(FilmPlane::variance) ? pixels * sizeof(Vec3d) : 0;
        constexpr std::size_t counter_bytes = sizeof(DeviceCounters);

        // Reserve memory
        auto memory = frames_->lease();
        memory->film.reserve(bytes);
        memory->one_sample.reserve(sample_bytes);
        memory->counters.reserve(counter_bytes);
        memory->counters_on_host.reserve(counter_bytes);
        std::shared_ptr<Vec3d> sums = film_memory(*films_, bytes);

        // Select the kernel: linked for the scene, or compiled ahead of time
        const EffectMask effects = resident.effects();
        const std::size_t variant = variant_for(variants, effects);
        SceneKernels::Found linked;
        if (specialise_ == Specialise::always) {
            linked = kernels_->find(job.tier, resident.view(),
                                    linked_facts(resident.view().scene, effects, job.limits, job.sampler));
        }
        const SceneKernel& kernel =
            linked.kernel != nullptr ? *linked.kernel : kernels_->compiled(job.tier, resident.view(), variant);
        compute_.wait_for(resident.uploaded());
        memory->render_start.record(compute_.get());
        check(cudaMemsetAsync(memory->counters.data(), 0, counter_bytes, compute_.get()), "clearing counters");
        auto* device_sums = reinterpret_cast<Vec3d*>(memory->film.data());
        auto* counters = reinterpret_cast<DeviceCounters*>(memory->counters.data());
        const auto height = static_cast<std::uint32_t>(window.height);
        const FilmPlanes planes = planes_in(device_sums, pixels, job.planes);
        const auto draw = [&](const PixelJob& samples, Vec3d* sums) {
            launch_render(kernel, resident.view(), samples, height, culls_pixels_, sums, counters, compute_.get());
        };
        if (planes.variance != nullptr) {
            draw_one_by_one(pixel_job, draw, *memory, pixels, planes.variance);
        } else {
            draw(pixel_job, device_sums);
        }
        if (job.planes.has_any(first_hit_planes)) {
            first_hits(job.tier)(resident.view(), first_hit_job(pixel_job, job.planes), height, planes, counters,
                                 compute_.get());
        }
        memory->render_end.record(compute_.get());

        // Start the download
        download_.wait_for(memory->render_end);
        memory->download_start.record(download_.get());
        check(cudaMemcpyAsync(sums.get(), memory->film.data(), bytes, cudaMemcpyDeviceToHost, download_.get()),
              "downloading the film");
        check(cudaMemcpyAsync(memory->counters_on_host.data(), memory->counters.data(), counter_bytes,
                              cudaMemcpyDeviceToHost, download_.get()),
              "downloading counters");
        memory->download_end.record(download_.get());

        const KernelFacts facts = kernel_facts(kernel.code.function());
        RenderResult result;
        result.film = Film(window.width, window.height, job.samples, std::move(sums), job.planes);
        if (!effects.has_any(counted_ray_effects)) result.stats.rays = pixels * pixel_job.samples;
        result.stats.counters.dropped_primitives = resident.dropped_primitives();
        result.stats.counters.dropped_lights = resident.dropped_lights();
        result.stats.device_bytes = resident.bytes() + bytes + sample_bytes;
        result.stats.registers = facts.registers;
        result.stats.occupancy = facts.occupancy;
        static constexpr const char* structure_names[] = {"few", "loop", "bvh"};
        result.stats.effects = effects;
        if (linked.kernel == nullptr) result.stats.carried = variants[variant].effects - effects - host_effects;
        result.stats.seconds.compile = linked.seconds;
        result.stats.warning = std::move(linked.warning);
        result.stats.variant = fmt::format("sm_{}{}, {}, {}", properties_.major, properties_.minor,
                                           structure_names[static_cast<int>(structure_of(resident.view()))],
                                           linked.kernel != nullptr ? "for the scene" : variants[variant].name);
        return std::make_unique<CudaFrame>(std::move(scene), std::move(memory), std::move(result));
    }

  private:
    /// Starts the samples one by one, so that their squares can be added; draw(job, film) starts those of a job. The
    /// sums have the same bits as from one kernel for all samples.
    template <class Draw>
    void draw_one_by_one(const PixelJob& job, Draw draw, const FrameMemory& memory, std::size_t pixels,
                         Vec3d* squares) {
        auto* sums = reinterpret_cast<Vec3d*>(memory.film.data());
        auto* sample = reinterpret_cast<Vec3d*>(memory.one_sample.data());
        for (Vec3d* zeros : {sums, squares}) {
            check(cudaMemsetAsync(zeros, 0, pixels * sizeof(Vec3d), compute_.get()), "clearing sums");
        }
        PixelJob one = job;
        one.samples = 1;
        for (std::uint32_t i = 0; i < job.samples; ++i) {
            one.first_sample = job.first_sample + i;
            check(cudaMemsetAsync(memory.counters.data() + offsetof(DeviceCounters, next_in_queue), 0,
                                  sizeof(DeviceCounters::next_in_queue), compute_.get()),
                  "resetting the queue of pixels");
            draw(one, sample);
            add_samples(sample, sums, squares, pixels, compute_.get());
        }
    }

    double trace(const DeviceScene& resident, const TraceJob& job) {
        const bool coherent = job.coherence == Coherence::unknown
                                  ? are_coherent(job.rays, reach(resident.view().bvh.frame.bounds))
                                  : job.coherence == Coherence::coherent;
        if (!coherent) candidates_.reserve(job.rays.size() * candidate_bytes);
        hits_.reserve(job.hits.size_bytes());
        wide_t_.reserve(job.wide_t.size_bytes());
        counters_.reserve(sizeof(DeviceCounters));
        counters_on_host_.reserve(sizeof(DeviceCounters));
        compute_.wait_for(resident.uploaded());
        const DeviceRays rays = {.rays = upload(job.rays, rays_),
                                 .sources = upload(job.sources, sources_),
                                 .ends = upload(job.ends, ends_),
                                 .hits = reinterpret_cast<Hit*>(hits_.data()),
                                 .wide_t = job.wide_t.empty() ? nullptr : reinterpret_cast<double*>(wide_t_.data()),
                                 .counters = reinterpret_cast<DeviceCounters*>(counters_.data()),
                                 .count = job.rays.size(),
                                 .candidates = candidates_.data(),
                                 .are_coherent = coherent};
        check(cudaMemsetAsync(counters_.data(), 0, sizeof(DeviceCounters), compute_.get()), "clearing counters");
        trace_start_.record(compute_.get());
        trace_kernels(resident.tier())(resident.view(), rays, compute_.get());
        trace_end_.record(compute_.get());
        download(job.hits, hits_);
        download(job.wide_t, wide_t_);
        check(cudaMemcpyAsync(counters_on_host_.data(), counters_.data(), sizeof(DeviceCounters),
                              cudaMemcpyDeviceToHost, compute_.get()),
              "downloading counters");
        check(cudaStreamSynchronize(compute_.get()), "tracing rays");
        if (job.counters != nullptr) *job.counters += to_render_counters(read(counters_on_host_));
        return seconds_between(trace_start_, trace_end_);
    }

    static void check(cudaError_t code, const char* doing) { cuda::check(code, doing); }
    static void check(const TraceJob& job) { tandem::check(job); }
    static void check(const RenderJob& job, Tier loaded_for) { tandem::check(job, loaded_for); }

    /// Starts a copy to the device and returns its address; null for an empty span.
    template <class T>
    const T* upload(std::span<const T> from, Buffer<DeviceMemory>& to) {
        if (from.empty()) return nullptr;
        to.reserve(from.size_bytes());
        check(cudaMemcpyAsync(to.data(), from.data(), from.size_bytes(), cudaMemcpyHostToDevice, compute_.get()),
              "uploading rays");
        return reinterpret_cast<const T*>(to.data());
    }

    /// Starts a copy to the host.
    template <class T>
    void download(std::span<T> to, const Buffer<DeviceMemory>& from) {
        if (to.empty()) return;
        check(cudaMemcpyAsync(to.data(), from.data(), to.size_bytes(), cudaMemcpyDeviceToHost, compute_.get()),
              "downloading hits");
    }

    Specialise specialise_;
    bool culls_pixels_;
    std::optional<SceneKernels> kernels_;
    cudaDeviceProp properties_{};
    Stream upload_, compute_, download_;
    std::shared_ptr<Pool<SceneMemory>> scenes_ = std::make_shared<Pool<SceneMemory>>();
    std::shared_ptr<Pool<FrameMemory>> frames_ = std::make_shared<Pool<FrameMemory>>();
    std::shared_ptr<FilmPool> films_ = std::make_shared<FilmPool>();
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

std::unique_ptr<Backend> make_cuda_backend(const BackendOptions& options) {
    return std::make_unique<CudaBackend>(options);
}

}  // namespace tandem
