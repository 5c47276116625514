/// The state of a path between the stages of a vertex (cuda/staged_paths.h). What each stage needs is in records of
/// their own, in units of 16 bytes. The records of a block's paths are in its shared memory; a few that few vertices
/// need are in device memory.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <cstring>

#include "tandem/kernel/path.h"
#include "tandem/math/whole.h"

namespace tandem::cuda {

/// The records in shared memory. Numbers of paths are those in their block.
template <class Real>
class PathRecords {
  public:
    // `before`: the bytes of the records before it
    struct alignas(16) RayRecord {
        static constexpr std::size_t before = 0;
        static constexpr std::uint32_t is_inside = 1, has_origin = 2, has_media = 4;
        static constexpr int vertex_shift = 3;

        Ray<Real> ray;
        std::uint32_t primitive;  ///< of the source
        std::uint32_t state;      ///< the bits above, and the number of the vertex that the ray leads to

        [[nodiscard]] TANDEM_HD std::uint32_t vertex() const { return state >> vertex_shift; }
        [[nodiscard]] TANDEM_HD bool has(std::uint32_t bit) const { return (state & bit) != 0; }
    };
    struct alignas(16) HitRecord {
        static constexpr std::size_t before = sizeof(RayRecord);
        Double<Real> t;
        std::uint32_t primitive;
        std::uint32_t sample;  ///< of the pixel, from 0
    };
    struct alignas(16) RadianceRecord {
        static constexpr std::size_t before = HitRecord::before + sizeof(HitRecord);
        Vec3<Real> radiance;
        std::uint32_t pixel;  ///< of the window: x in the lower half, y in the upper
    };
    struct alignas(16) ThroughputRecord {  ///< undefined for camera rays
        static constexpr std::size_t before = RadianceRecord::before + sizeof(RadianceRecord);
        Vec3<Real> throughput;
        std::uint32_t counts;  ///< reflections, refractions, scatterings and masked hits, a byte each
    };
    struct alignas(16) DensityRecord {  ///< undefined unless `has_origin`
        static constexpr std::size_t before = ThroughputRecord::before + sizeof(ThroughputRecord);
        Double<Real> pdf, masked_t;
    };
    struct alignas(16) OriginRecord {  ///< likewise
        static constexpr std::size_t before = DensityRecord::before + sizeof(DensityRecord);
        Vec3<Real> sampled_from;
        std::uint32_t masked_primitive;
    };

    /// Of one path: an odd number of units, so that threads that read the same record of any paths use all banks of the
    /// memory.
    static constexpr std::size_t bytes =
        ((OriginRecord::before + sizeof(OriginRecord)) / sizeof(uint4) | 1) * sizeof(uint4);

    /// `memory`: `bytes` for each path, aligned to 16.
    TANDEM_HD explicit PathRecords(void* memory) : units_(static_cast<uint4*>(memory)) {}

    template <class Record>
    [[nodiscard]] TANDEM_HD Record load(std::uint32_t path) const {
        uint4 read[units<Record>];
        TANDEM_UNROLL
        for (std::uint32_t i = 0; i < units<Record>; ++i) read[i] = unit<Record>(i, path);
        Record record;
        std::memcpy(&record, read, sizeof(Record));
        return record;
    }
    template <class Record>
    TANDEM_HD void store(const Record& record, std::uint32_t path) const {
        uint4 written[units<Record>];
        std::memcpy(written, &record, sizeof(Record));
        TANDEM_UNROLL
        for (std::uint32_t i = 0; i < units<Record>; ++i) unit<Record>(i, path) = written[i];
    }

  private:
    template <class Record>
    static constexpr std::uint32_t units = sizeof(Record) / sizeof(uint4);
    template <class Record>
    [[nodiscard]] TANDEM_HD uint4& unit(std::uint32_t number, std::uint32_t path) const {
        return units_[path * (bytes / sizeof(uint4)) + Record::before / sizeof(uint4) + number];
    }

    uint4* units_;
};

/// The records in device memory, of one path.
template <class Real>
struct RarePathRecords {
    struct alignas(16) Shadow {
        Ray<Real> ray;
        Double<Real> t_max;
        std::uint32_t primitive, light;
        Vec3<Real> lit;  ///< the radiance of the path if nothing blocks the ray
        bool inside;
    };

    struct alignas(16) Media {
        MediumStack<Real> stack;
    };

    Media media;  ///< undefined unless RayRecord::has_media
    Shadow shadow;
    alignas(16) Vec3d sum;  ///< of the samples of the pixel so far
};

/// The path of `number`, whose ray was loaded. `has_throughput`: whether that of a camera ray is stored too.
template <class Effects, class Real>
[[nodiscard]] TANDEM_HD PathState<Effects, Real> load_path(const SceneView& scene, const PathRecords<Real>& records,
                                                           const RarePathRecords<Real>& rare, std::uint32_t number,
                                                           const typename PathRecords<Real>::RayRecord& ray,
                                                           bool has_throughput = false) {
    using Records = PathRecords<Real>;
    using RayRecord = typename Records::RayRecord;
    PathState<Effects, Real> path;
    path.begin(scene, ray.ray, true);
    path.source.primitive = ray.primitive;
    path.source.inside = ray.has(RayRecord::is_inside);
    if (has_throughput || ray.vertex() > 0) {
        const auto record = records.template load<typename Records::ThroughputRecord>(number);
        path.throughput = record.throughput;
        path.reflections = record.counts & 0xFF;
        path.refractions = record.counts >> 8 & 0xFF;
        path.scatterings = record.counts >> 16 & 0xFF;
        path.masked_hits = record.counts >> 24;
    }
    if (ray.has(RayRecord::has_origin)) {
        const auto density = records.template load<typename Records::DensityRecord>(number);
        const auto origin = records.template load<typename Records::OriginRecord>(number);
        path.pdf = density.pdf;
        path.sampled_from = origin.sampled_from;
        path.source.last_masked = {density.masked_t, origin.masked_primitive};
    }
    if (Effects::has(Effect::nested_media) && ray.has(RayRecord::has_media)) path.media = whole(rare.media).stack;
    return path;
}

/// Stores what a path keeps of its light.
template <class Effects, class Real>
TANDEM_HD void store_throughput(const PathState<Effects, Real>& path, const PathRecords<Real>& records,
                                std::uint32_t number) {
    using Record = typename PathRecords<Real>::ThroughputRecord;
    records.store(Record{path.throughput,
                         path.reflections | path.refractions << 8 | path.scatterings << 16 | path.masked_hits << 24},
                  number);
}

/// Stores a path whose ray leads to `vertex`.
template <class Effects, class Real>
TANDEM_HD void store_path(const SceneView& scene, const PathState<Effects, Real>& path, std::uint32_t vertex,
                          const PathRecords<Real>& records, RarePathRecords<Real>& rare, std::uint32_t number) {
    using Records = PathRecords<Real>;
    using RayRecord = typename Records::RayRecord;
    std::uint32_t state = vertex << RayRecord::vertex_shift | (path.source.inside ? RayRecord::is_inside : 0U);
    const bool is_masked = Effects::has(Effect::cutouts) && path.source.last_masked.primitive != no_primitive;
    if (is_masked || !(path.pdf == Double<Real>(0.0))) {
        state |= RayRecord::has_origin;
        records.store(typename Records::DensityRecord{path.pdf, path.source.last_masked.t}, number);
        records.store(typename Records::OriginRecord{path.sampled_from, path.source.last_masked.primitive}, number);
    }
    if (Effects::has(Effect::nested_media) && !(path.media == media_at_camera<Effects>(scene, MediumStack<Real>()))) {
        state |= RayRecord::has_media;
        rare.media = {path.media};
    }
    store_throughput(path, records, number);
    records.store(RayRecord{path.ray, path.source.primitive, state}, number);
}

}  // namespace tandem::cuda
