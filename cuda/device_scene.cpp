#include "cuda/device_scene.h"

#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "tandem/base/seconds.h"
#include "tandem/compile/build_bvh.h"

namespace tandem::cuda {

namespace {

/// Up to this number of primitives a kernel tests all of them (docs/performance.md).
constexpr std::size_t loop_limit = 12;

/// Up to this number the whole hierarchy would be built on the host in any case (effort_for()), so all of it is.
constexpr std::size_t host_limit = 4096;

/// Lays out arrays one after another, each aligned for 16-byte loads.
class Layout {
  public:
    /// `pointer` will point to the array's copy on the GPU.
    template <class T>
    void add(const std::vector<T>& array, const T*& pointer) {
        parts_.push_back({bytes_, array.data(), array.size() * sizeof(T),
                          [&pointer](std::byte* copy) { pointer = reinterpret_cast<const T*>(copy); }});
        bytes_ += (array.size() * sizeof(T) + alignment - 1) / alignment * alignment;
    }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    /// Copies the arrays to `staging`, and sets the pointers to their addresses on the GPU.
    void place(std::byte* staging, std::byte* device) const {
        for (const Part& part : parts_) {
            if (part.bytes > 0) std::memcpy(staging + part.offset, part.data, part.bytes);
            part.point(device + part.offset);
        }
    }

  private:
    static constexpr std::size_t alignment = 256;
    struct Part {
        std::size_t offset;
        const void* data;
        std::size_t bytes;
        std::function<void(std::byte*)> point;
    };
    std::vector<Part> parts_;
    std::size_t bytes_ = 0;
};

Aabb scene_bounds(const SceneView& scene) {
    Aabb bounds;
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) bounds = merge(bounds, primitive_bounds(scene, id));
    return bounds;
}

/// Memory that the next frame needs again is kept unless it is much of what the GPU has.
void release_if_large(Buffer<DeviceMemory>& scratch) {
    std::size_t free = 0, all = 0;
    check(cudaMemGetInfo(&free, &all), "asking for the GPU's memory");
    if (scratch.capacity() > all / 16) scratch = {};
}

}  // namespace

DeviceScene::DeviceScene(const PreparedScene& scene, Tier tier, std::shared_ptr<SceneMemory> memory, Stream& stream)
    : ResidentScene(tier),
      memory_(std::move(memory)),
      camera_(scene.camera),
      effects_(scene.effects),
      dropped_primitives_(scene.dropped_primitives),
      dropped_lights_(scene.dropped_lights) {
    const SceneView host = tandem::view(scene);
    const std::size_t count = primitive_count(scene);
    Bvh bvh;
    if (count > loop_limit && count <= host_limit) {
        const Stopwatch watch;
        view_.bvh.frame = make_structure_frame(scene_bounds(host));
        bvh = tandem::build_bvh(host, view_.bvh.frame.margin);
        bvh_nodes_ = static_cast<std::uint32_t>(bvh.nodes.size());
        host_build_seconds_ = watch.seconds();
    }

    view_.scene = host;
    Layout layout;
#define TANDEM_SCENE_ARRAY(Type, names) layout.add(scene.names, view_.scene.names);
#include "tandem/kernel/view/scene_arrays.def"
    if (has_textures(host.textures)) {
#define TANDEM_TEXTURE_ARRAY(Type, names) layout.add(scene.textures.names, view_.scene.textures.names);
#include "tandem/kernel/texture/texture_arrays.def"
#undef TANDEM_TEXTURE_ARRAY
    }
    if (!bvh.nodes.empty()) {
        layout.add(bvh.nodes, view_.bvh.nodes);
        layout.add(bvh.entry_spheres, view_.bvh.entry_spheres);
        layout.add(bvh.entry_ids, view_.bvh.entry_ids);
        layout.add(bvh.placements, view_.bvh.placements);
        layout.add(bvh.entry_triangles, view_.bvh.entry_triangles);
    }
    bytes_ = layout.bytes();
    memory_->device.reserve(bytes_);
    memory_->staging.reserve(bytes_);
    layout.place(memory_->staging.data(), memory_->device.data());

    if (fits_constant_memory(host)) view_.few = make_constant_memory_tracer(host, view_.scene);

    memory_->upload_start.record(stream.get());
    if (bytes_ > 0) {
        check(cudaMemcpyAsync(memory_->device.data(), memory_->staging.data(), bytes_, cudaMemcpyHostToDevice,
                              stream.get()),
              "uploading the scene");
    }
    memory_->upload_end.record(stream.get());
    if (count > host_limit) {
        const BuiltBvh built =
            build_bvh(view_.scene, memory_->bvh, stream.get(), effort_for(static_cast<std::uint32_t>(count)));
        release_if_large(memory_->bvh.scratch);
        view_.bvh = built.view;
        bvh_nodes_ = built.node_count;
    }
    memory_->build_end.record(stream.get());
}

PhaseTimes DeviceScene::load_times() const {
    memory_->build_end.wait();
    PhaseTimes times;
    times.build = host_build_seconds_ + seconds_between(memory_->upload_end, memory_->build_end);
    times.upload = seconds_between(memory_->upload_start, memory_->upload_end);
    return times;
}

}  // namespace tandem::cuda
