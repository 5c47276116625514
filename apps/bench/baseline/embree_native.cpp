#include "embree_native.h"

#if TANDEM_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <limits>

#include "tandem/base/error.h"

namespace tandem::bench {

namespace {

constexpr std::size_t rays_per_task = 1024;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void intersect(RTCScene scene, RTCRayHit& query) {
#if TANDEM_EMBREE_MAJOR >= 4
    rtcIntersect1(scene, &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
#endif
}

Hit trace_one(RTCScene scene, const Ray<float>& ray) {
    RTCRayHit query{};
    query.ray.org_x = ray.origin.x;
    query.ray.org_y = ray.origin.y;
    query.ray.org_z = ray.origin.z;
    query.ray.dir_x = ray.direction.x;
    query.ray.dir_y = ray.direction.y;
    query.ray.dir_z = ray.direction.z;
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0U;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(scene, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {query.ray.tfar, query.hit.primID};
}

}  // namespace

struct EmbreeNative::State {
    State(int threads, EmbreeFlags flags) : arena(threads == 0 ? tbb::task_arena::automatic : threads) {
        // Embree builds with the threads of this arena.
        device = rtcNewDevice(nullptr);
        if (device == nullptr) throw EnvironmentError("Embree cannot create a device on this machine");
        scene = rtcNewScene(device);
        if (flags == EmbreeFlags::robust) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    }
    ~State() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    /// Adds the geometry, whose buffers are set, to the scene and builds it.
    void build(RTCGeometry geometry, std::size_t primitives) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        const auto start = std::chrono::steady_clock::now();
        arena.execute([&] { rtcJoinCommitScene(scene); });
        build_seconds = seconds_since(start);
        const RTCError error = rtcGetDeviceError(device);
        if (error != RTC_ERROR_NONE) {
            throw EnvironmentError(fmt::format("Embree cannot build a scene of {} primitives: error {}", primitives,
                                               static_cast<int>(error)));
        }
    }

    tbb::task_arena arena;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    double build_seconds = 0;
};

EmbreeNative::EmbreeNative(std::span<const Sphere> spheres, int threads, EmbreeFlags flags)
    : state_(std::make_unique<State>(threads, flags)) {
    RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                                                 4 * sizeof(float), spheres.size()));
    for (std::size_t i = 0; vertices != nullptr && i < spheres.size(); ++i) {
        vertices[4 * i] = spheres[i].centre.x;
        vertices[4 * i + 1] = spheres[i].centre.y;
        vertices[4 * i + 2] = spheres[i].centre.z;
        vertices[4 * i + 3] = spheres[i].radius;
    }
    state_->build(geometry, spheres.size());
}

EmbreeNative::EmbreeNative(std::span<const Triangle> triangles, int threads, EmbreeFlags flags)
    : state_(std::make_unique<State>(threads, flags)) {
    RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 sizeof(Vec3f), 3 * triangles.size()));
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
    for (std::size_t i = 0; vertices != nullptr && corners != nullptr && i < triangles.size(); ++i) {
        vertices[3 * i] = triangles[i].v0;
        vertices[3 * i + 1] = triangles[i].v1;
        vertices[3 * i + 2] = triangles[i].v2;
        for (std::size_t k = 0; k < 3; ++k) corners[3 * i + k] = static_cast<std::uint32_t>(3 * i + k);
    }
    state_->build(geometry, triangles.size());
}

EmbreeNative::~EmbreeNative() = default;

double EmbreeNative::trace(std::span<const Ray<float>> rays, std::span<Hit> hits) {
    const auto start = std::chrono::steady_clock::now();
    state_->arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), rays_per_task), [&](const auto& block) {
            for (std::size_t i = block.begin(); i < block.end(); ++i) hits[i] = trace_one(state_->scene, rays[i]);
        });
    });
    return seconds_since(start);
}

double EmbreeNative::build_seconds() const { return state_->build_seconds; }

std::string EmbreeNative::version() { return "Embree " RTC_VERSION_STRING; }

}  // namespace tandem::bench
