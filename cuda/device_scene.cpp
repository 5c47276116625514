#include "cuda/device_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "tandem/base/memory.h"
#include "tandem/base/parallel.h"
#include "tandem/compile/crossed_boxes.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem::cuda {

namespace {

/// Up to this number of primitives a kernel tests all of them (docs/performance/hierarchies.md).
constexpr std::size_t loop_limit = 12;

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
    /// Sets the pointers to the addresses of the arrays on the GPU.
    void point(std::byte* device) const {
        for (const Part& part : parts_) part.point(device + part.offset);
    }
    /// Copies the arrays to the GPU, in pieces: one is filled while the one before is under way. So the page-locked
    /// memory, which takes long to make, is small beside a large scene.
    void upload(SceneMemory& memory, Stream& stream) const {
        memory.staging.reserve(bytes_ <= piece_bytes ? bytes_ : 2 * piece_bytes);
        std::size_t turn = 0;
        for (std::size_t begin = 0; begin < bytes_; begin += piece_bytes, turn ^= 1) {
            const std::size_t bytes = std::min(piece_bytes, bytes_ - begin);
            std::byte* const staging = memory.staging.data() + turn * piece_bytes;
            memory.piece_copied[turn].wait();  // at once if there was none
            for_each_chunk(bytes, bytes_at_once, [&](const Chunk& chunk) { fill(staging, begin, chunk); });
            check(cudaMemcpyAsync(memory.device.data() + begin, staging, bytes, cudaMemcpyHostToDevice, stream.get()),
                  "uploading the scene");
            memory.piece_copied[turn].record(stream.get());
        }
    }

  private:
    static constexpr std::size_t alignment = 256, piece_bytes = std::size_t{1} << 24, bytes_at_once = 1U << 20;

    /// Fills a range of `staging` from the parts. The first byte of `staging` is byte `begin` of the layout.
    void fill(std::byte* staging, std::size_t begin, const Chunk& range) const {
        for (const Part& part : parts_) {
            const std::size_t from = std::max(part.offset, begin + range.begin);
            const std::size_t to = std::min(part.offset + part.bytes, begin + range.end);
            if (from >= to) continue;
            std::memcpy(staging + (from - begin), static_cast<const std::byte*>(part.data) + (from - part.offset),
                        to - from);
        }
    }

    struct Part {
        std::size_t offset;
        const void* data;
        std::size_t bytes;
        std::function<void(std::byte*)> point;
    };
    std::vector<Part> parts_;
    std::size_t bytes_ = 0;
};

/// Whether rays pass close to many triangles before they hit one, so that traversals of neighbouring rays differ in
/// length. The limit was tried in a sphere of fine triangles and in a million triangles without order
/// (docs/performance/hierarchies.md).
bool rays_diverge(const SceneView& scene, const Aabb& bounds) {
    constexpr double many = 8;
    return scene.triangle_count == primitive_count(scene) && crossed_boxes(scene, bounds) > many;
}

constexpr std::size_t much_memory = std::size_t{1} << 28;

/// Releases memory that the next frame needs again only if it is much of the GPU's memory.
void release_if_large(Buffer<DeviceMemory>& scratch) {
    if (scratch.capacity() < much_memory) return;  // asking takes time
    std::size_t free = 0, all = 0;
    check(cudaMemGetInfo(&free, &all), "asking for the GPU's memory");
    if (scratch.capacity() > all / 16) scratch = {};
}

/// Throws EnvironmentError, before the upload, if the GPU cannot hold a scene with arrays of `bytes`.
void require_room(const SceneMemory& memory, std::size_t bytes, std::size_t primitives) {
    const std::size_t for_hierarchy = primitives > loop_limit ? primitives * build_bytes_per_primitive : 0;
    if (bytes + for_hierarchy < much_memory) return;
    std::size_t free = 0, all = 0;
    check(cudaMemGetInfo(&free, &all), "asking for the GPU's memory");
    const std::size_t ours = memory.device.capacity() + memory.bvh.tree.capacity() + memory.bvh.scratch.capacity();
    require_memory(bytes + for_hierarchy, free + ours, fmt::format("the scene of {} primitives", primitives),
                   "GPU memory");
}

}  // namespace

DeviceScene::DeviceScene(const PreparedScene& scene, Tier tier, std::shared_ptr<SceneMemory> memory, Stream& stream,
                         bool refits)
    : ResidentScene(tier),
      memory_(std::move(memory)),
      camera_(scene.camera),
      effects_(scene.effects),
      dropped_primitives_(scene.dropped_primitives),
      dropped_lights_(scene.dropped_lights) {
    const SceneView host = tandem::view(scene);
    view_.scene = host;
    Layout layout;
#define TANDEM_SCENE_ARRAY(Type, names) layout.add(scene.names, view_.scene.names);
#include "tandem/kernel/view/scene_arrays.def"
    if (has_textures(host.textures)) {
#define TANDEM_TEXTURE_ARRAY(Type, names) layout.add(scene.textures.names, view_.scene.textures.names);
#include "tandem/kernel/texture/texture_arrays.def"
#undef TANDEM_TEXTURE_ARRAY
    }
    const PreparedInstances& instances = scene.instances;
    const InstancedBvh instanced_bvh = instances.empty() ? InstancedBvh{} : build_instanced_bvh(scene);
    layout.add(instances.instances, view_.instanced.instances);
    layout.add(instances.meshes, view_.instanced.meshes);
    layout.add(instances.faces, view_.instanced.faces);
    layout.add(instances.normals, view_.instanced.mesh_normals);
    layout.add(instanced_bvh.nodes, view_.instanced_bvh.nodes);
    layout.add(instanced_bvh.entry_instances, view_.instanced_bvh.entry_instances);
    layout.add(instanced_bvh.entry_faces, view_.instanced_bvh.entry_faces);
    bytes_ = layout.bytes();
    require_room(*memory_, bytes_, primitive_count(scene));
    memory_->device.reserve(bytes_);
    layout.point(memory_->device.data());

    if (instances.empty()) {
        view_.instanced = {};
        view_.instanced_bvh = {};
    } else {
        view_.instanced.mesh_count = static_cast<std::uint32_t>(instances.meshes.size());
        view_.instanced_bvh.instance_entries = static_cast<std::uint32_t>(instanced_bvh.entry_instances.size());
        view_.instanced_bvh.frame = instanced_bvh.frame;
    }
    static_cast<SceneView&>(view_.instanced) = view_.scene;
    view_.instanced.first_instanced_id = static_cast<std::uint32_t>(primitive_count(scene));
    if (instances.empty() && fits_constant_memory(host)) {
        view_.few = make_constant_memory_tracer(host, view_.scene);
        view_.certain = make_certain_scene(host);
    }

    memory_->upload_start.record(stream.get());
    layout.upload(*memory_, stream);
    memory_->upload_end.record(stream.get());
    const std::size_t most_tested = instances.empty() ? loop_limit : 0;
    if (primitive_count(scene) > most_tested) {
        const BuiltBvh built = memory_->lasting_bvh.of(view_.scene, memory_->bvh, stream.get(), refits);
        view_.bvh = built.view;
        bvh_nodes_ = built.node_count;
        view_.diverges = rays_diverge(host, built.view.frame.bounds);
    }
    memory_->build_end.record(stream.get());
    release_if_large(memory_->bvh.scratch);
}

PhaseTimes DeviceScene::load_times() const {
    memory_->build_end.wait();
    PhaseTimes times;
    times.build = seconds_between(memory_->upload_end, memory_->build_end);
    times.upload = seconds_between(memory_->upload_start, memory_->upload_end);
    return times;
}

}  // namespace tandem::cuda
