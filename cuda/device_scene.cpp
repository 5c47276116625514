#include "cuda/device_scene.h"

#include <cstring>

#include "tandem/bvh/bvh.h"
#include "tandem/render/seconds.h"

namespace tandem::cuda {

namespace {

/// Up to here a kernel tries every primitive (docs/performance.md has the crossing point).
constexpr std::size_t loop_limit = 12;

/// Lays arrays out one behind another, each aligned for 16-byte loads.
class Layout {
  public:
    /// Place of an array in the buffer to come.
    template <class T>
    std::size_t add(const std::vector<T>& array) {
        const std::size_t at = bytes_;
        parts_.push_back({at, array.data(), array.size() * sizeof(T)});
        bytes_ += (array.size() * sizeof(T) + alignment - 1) / alignment * alignment;
        return at;
    }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    void write(std::byte* target) const {
        for (const Part& part : parts_) {
            if (part.bytes > 0) std::memcpy(target + part.offset, part.data, part.bytes);
        }
    }

  private:
    static constexpr std::size_t alignment = 256;
    struct Part {
        std::size_t offset;
        const void* data;
        std::size_t bytes;
    };
    std::vector<Part> parts_;
    std::size_t bytes_ = 0;
};

Aabb scene_bounds(const SceneView& scene) {
    Aabb bounds;
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) bounds = merge(bounds, primitive_bounds(scene, id));
    return bounds;
}

}  // namespace

DeviceScene::DeviceScene(const PreparedScene& scene, Tier tier, std::shared_ptr<SceneMemory> memory, Stream& stream)
    : ResidentScene(tier), memory_(std::move(memory)) {
    camera_.render_from_camera = scene.render_from_camera;
    camera_.orthographic = scene.orthographic;
    camera_.half_height = scene.half_height;
    camera_.effects = scene.effects;
    camera_.lens = scene.lens;
    camera_.dropped_primitives = scene.dropped_primitives;
    camera_.dropped_lights = scene.dropped_lights;

    const SceneView host = tandem::view(scene);
    Bvh bvh;
    if (primitive_count(scene) > loop_limit) {
        const Stopwatch watch;
        view_.bvh.frame = make_structure_frame(scene_bounds(host));
        bvh = build_bvh(host, view_.bvh.frame.margin);
        build_seconds_ = watch.seconds();
    }

    Layout layout;
#define TANDEM_PRIMITIVE(Type, name, names) const std::size_t names = layout.add(scene.names);
#include "tandem/scene/primitives.def"
#undef TANDEM_PRIMITIVE
    const std::size_t normals = layout.add(scene.normals);
    const std::size_t material_of = layout.add(scene.material_of);
    const std::size_t materials = layout.add(scene.materials);
    const std::size_t optics = layout.add(scene.optics);
    const std::size_t lights = layout.add(scene.lights);
    const std::size_t area_lights = layout.add(scene.area_lights);
    const std::size_t texcoords = layout.add(scene.texcoords);
    const std::size_t texels = layout.add(scene.textures.texels);
    const std::size_t textures = layout.add(scene.textures.textures);
    const std::size_t material_textures = layout.add(scene.textures.materials);
    const std::size_t levels = layout.add(scene.textures.levels);
    const std::size_t nodes = layout.add(bvh.nodes);
    const std::size_t entry_spheres = layout.add(bvh.entry_spheres);
    const std::size_t entry_ids = layout.add(bvh.entry_ids);
    bytes_ = layout.bytes();
    memory_->device.reserve(bytes_);
    memory_->staging.reserve(bytes_);
    layout.write(memory_->staging.data());

    std::byte* base = memory_->device.data();
    view_.scene = host;
#define TANDEM_PRIMITIVE(Type, name, names) view_.scene.names = reinterpret_cast<const Type*>(base + names);
#include "tandem/scene/primitives.def"
#undef TANDEM_PRIMITIVE
    view_.scene.normals = reinterpret_cast<const Vec3f*>(base + normals);
    view_.scene.material_of = reinterpret_cast<const std::uint32_t*>(base + material_of);
    view_.scene.materials = reinterpret_cast<const PhongMaterial*>(base + materials);
    view_.scene.optics = reinterpret_cast<const Optics*>(base + optics);
    view_.scene.lights = reinterpret_cast<const PunctualLight*>(base + lights);
    view_.scene.area_lights = reinterpret_cast<const AreaLight*>(base + area_lights);
    view_.scene.texcoords = reinterpret_cast<const Vec2f*>(base + texcoords);
    if (has_textures(view_.scene.textures)) {
        view_.scene.textures = {reinterpret_cast<const std::uint32_t*>(base + texels),
                                reinterpret_cast<const TextureDescriptor*>(base + textures),
                                reinterpret_cast<const MaterialTextures*>(base + material_textures),
                                reinterpret_cast<const float*>(base + levels)};
    }
    if (!bvh.nodes.empty()) {
        view_.bvh.nodes = reinterpret_cast<const BvhNode*>(base + nodes);
        view_.bvh.entry_spheres = reinterpret_cast<const Sphere*>(base + entry_spheres);
        view_.bvh.entry_ids = reinterpret_cast<const std::uint32_t*>(base + entry_ids);
    }

    if (fits_few_tracer(host)) view_.few = make_few_tracer(host, view_.scene);

    memory_->upload_start.record(stream.get());
    if (bytes_ > 0) {
        check(cudaMemcpyAsync(base, memory_->staging.data(), bytes_, cudaMemcpyHostToDevice, stream.get()),
              "uploading the scene");
    }
    memory_->upload_end.record(stream.get());
}

PhaseTimes DeviceScene::load_times() const {
    memory_->upload_end.wait();
    PhaseTimes times;
    times.build = build_seconds_;
    times.upload = seconds_between(memory_->upload_start, memory_->upload_end);
    return times;
}

}  // namespace tandem::cuda
