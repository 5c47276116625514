/// Sorts paths between packets by what they hit, to reduce divergence.
#pragma once

#include <bit>
#include <cstring>
#include <utility>

#include "cpu/kernels.h"
#include "tandem/kernel/path_walk.h"
#include "tandem/math/lanes.h"

namespace tandem {

/// For each lane of a packet, a lane of some packet.
template <class Isa>
struct LanePlaces {
    using Word = Lanes<std::uint32_t, Isa>;
    Word packet;  ///< offset from the first packet, in bytes
    Word lane;

    /// Gathers the numbers at these places. `first`: the member of the first packet.
    template <class T>
    [[nodiscard]] TANDEM_HD_INLINE Lanes<T, Isa> gather(const Lanes<T, Isa>& first) const {
        return Lanes<T, Isa>::gather(&first, packet + (lane << (sizeof(T) == 8 ? 3 : 2)));
    }
    [[nodiscard]] TANDEM_HD_INLINE LaneMask<Isa> gather(const LaneMask<Isa>& first) const {
        return gather_mask(&first, packet, lane);
    }
};

/// Several packets of paths. A packet runs the code for everything that any of its paths hits, and paths diverge after
/// their first hit. So once the next hit of each path is known, the paths are sorted by it. Moving a path to another
/// lane changes no bit: tested by tests/agree/effects_test.cpp, with packets of 4, 8 and 16 and the GPU. Source: S.
/// Laine, T. Karras, T. Aila, "Megakernels Considered Harmful", HPG 2013, who sort by material.
template <class Effects, class Real>
class PathSorter {
  public:
    /// Fills lanes without a pixel: take(free, x, y) sets x and y in lanes of `free` and returns the lanes that it set.
    template <class Take>
    TANDEM_HD_INLINE void take(const PixelJob& job, Take take) {
        UInt<Real> x(0U), y(0U);
        for (int i = 0; i < packet_count; ++i) {
            Walk& walk = now_[i].walk;
            const Mask<Real> free = !walk.working();
            if (!any(free)) continue;
            const Mask<Real> taken = take(free, x, y);
            walk.take(job, x, y, taken);
        }
    }

    /// Advances all paths by one vertex, and adds the radiance of those that end to `sums`, by pixel. False if there
    /// was no path.
    template <class Tracer>
    TANDEM_HD_INLINE bool step(const Tracer& tracer, const SceneView& scene, const PixelJob& job, Vec3d* sums,
                               TileStats& stats) {
        Mask<Real> working(false), leaves_surface(false);
        for (int i = 0; i < packet_count; ++i) {
            working = working || now_[i].walk.working();
            leaves_surface = leaves_surface || now_[i].walk.leaves_surface();
        }
        if (!any(working)) return false;
        // camera rays are coherent anyway
        const bool sorts = any(leaves_surface);
        const int together = sorts ? packet_count : 1;
        PathTally<Real> tally;
        for (int first = 0; first < packet_count; first += together) {
            for (int i = first; i < first + together; ++i) {
                Packet& packet = now_[i];
                if (any(packet.walk.working())) packet.hit = packet.walk.find(tracer, scene, job, tally);
            }
            if (sorts) sort(scene);
            for (int i = first; i < first + together; ++i) {
                Walk& walk = now_[i].walk;
                if (!any(walk.working())) continue;
                const Mask<Real> ended = walk.leave(tracer, scene, job, now_[i].hit, tally);
                if (any(ended)) add(walk.radiance(), walk.pixel(job), ended, sums, stats);
            }
        }
        stats.add(tally);
        return true;
    }

  private:
    using Isa = typename Real::Isa;
    using Word = UInt<Real>;
    using Walk = PathWalk<Effects, Real>;
    static constexpr int packet_count = 8;
    static constexpr int path_count = packet_count * Real::size;

    struct Packet {
        Walk walk;
        Closest<Real> hit = no_hit<Real>();

        TANDEM_HD_INLINE auto per_lane() { return std::tuple_cat(std::tie(hit.t, hit.primitive), walk.per_lane()); }
    };

    // Sorts by primitive or, if there are many, by material; paths that hit nothing and lanes without a path come last.
    static constexpr std::uint32_t bucket_count = 64;
    static constexpr std::uint32_t no_path = bucket_count - 1;
    static constexpr std::uint32_t nothing = bucket_count - 2;

    TANDEM_HD_INLINE static Word buckets_of(const SceneView& scene, const Packet& packet) {
        const Mask<Real> working = packet.walk.working();
        const Word primitive = packet.hit.primitive;
        const Mask<Real> missed = primitive == Word(no_primitive);
        Word bucket = primitive;
        if (primitive_count(scene) > nothing) {
            for (int i = 0; i < Real::size; ++i) {
                if (working[i] && !missed[i]) set_lane(bucket, i, scene.material_of[primitive[i]] % nothing);
            }
        }
        return select(working, select(missed, Word(nothing), bucket), Word(no_path));
    }

    TANDEM_HD_INLINE void sort(const SceneView& scene) {
        alignas(64) std::uint32_t bucket[path_count];
        std::uint32_t first[bucket_count + 1] = {};
        for (int i = 0; i < packet_count; ++i) {
            const Word buckets = buckets_of(scene, now_[i]);
            std::memcpy(bucket + i * Real::size, &buckets, sizeof(buckets));
        }
        for (const std::uint32_t b : bucket) ++first[b + 1];
        for (std::uint32_t b = 0; b < bucket_count; ++b) first[b + 1] += first[b];
        alignas(64) std::uint32_t from[path_count];
        std::uint32_t moved = 0;
        for (std::uint32_t i = 0; i < path_count; ++i) {
            const std::uint32_t to = first[bucket[i]]++;
            from[to] = i;
            moved |= to ^ i;
        }
        if (moved == 0) return;
        const bool has_masks = scene.cutout_kinds != 0;
        const bool shares_light =
            scene.area_light_count > 0 && (scene.indirect_light != 0 || has_material_parts(scene));
        for (int i = 0; i < packet_count; ++i) {
            Word path;
            std::memcpy(&path, from + i * Real::size, sizeof(path));
            constexpr std::uint32_t size = Real::size;
            LanePlaces<Isa> places;
            places.lane = path & Word(size - 1);
            places.packet = (path >> std::countr_zero(size)) * Word(static_cast<std::uint32_t>(sizeof(Packet)));
            fetch(places, next_[i].per_lane(), now_[0].per_lane());
            if (has_masks) fetch(places, next_[i].walk.per_lane_of_masks(), now_[0].walk.per_lane_of_masks());
            if (shares_light) fetch(places, next_[i].walk.per_lane_of_lights(), now_[0].walk.per_lane_of_lights());
        }
        std::swap(now_, next_);
    }

    /// `to`, `from`: references to values of the packet and of the first one.
    template <class Values>
    TANDEM_HD_INLINE static void fetch(const LanePlaces<Isa>& places, Values to, Values from) {
        [&]<std::size_t... i>(std::index_sequence<i...>) {
            ((std::get<i>(to) = places.gather(std::get<i>(from))), ...);
        }
        (std::make_index_sequence<std::tuple_size_v<Values>>());
    }

    TANDEM_HD_INLINE static void add(const Vec3<Real>& radiance, const Word& pixel, const Mask<Real>& ended,
                                     Vec3d* sums, TileStats& stats) {
        const Mask<Real> valid = is_finite(radiance);
        const Vec3<Wide<Real>> wide = to_wide(radiance);
        for (unsigned int rest = (ended && valid).bits(); rest != 0; rest &= rest - 1) {
            const int i = lowest_bit(rest);
            Vec3d& sum = sums[pixel[i]];
            sum = sum + Vec3d{wide.x[i], wide.y[i], wide.z[i]};
        }
        stats.counters.invalid_samples += static_cast<std::uint64_t>(std::popcount((ended && !valid).bits()));
    }

    Packet memory_[2][packet_count];
    Packet* now_ = memory_[0];
    Packet* next_ = memory_[1];
};

}  // namespace tandem
