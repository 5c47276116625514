/// Sorts paths between packets by what they hit, to reduce divergence.
#pragma once

#include <bit>
#include <cstring>
#include <utility>

#include "cpu/kernels.h"
#include "cpu/sample_sets.h"
#include "tandem/kernel/path_walk.h"
#include "tandem/math/pick_lanes.h"

namespace tandem {

/// Several packets of paths. A packet runs the code for everything that any of its paths hits, and paths diverge after
/// their first hit. So once the next hit of each path is known, the paths are sorted by it. Moving a path to another
/// lane changes no bit: tested by tests/agree/effects_test.cpp, with packets of 4, 8 and 16 and the GPU. Source: S.
/// Laine, T. Karras, T. Aila, "Megakernels Considered Harmful", HPG 2013, who sort by material.
template <class Effects, class Real>
class PathSorter {
  public:
    /// Gives samples to lanes without one.
    TANDEM_HD_INLINE void take(SampleSets<Real>& samples) {
        for (int i = 0; i < packet_count; ++i) {
            Packet& packet = now_[i];
            const Mask<Real> idle = !packet.walk.working();
            if (!any(idle)) continue;
            const LaneSamples<Real> next = samples.take(idle);
            packet.walk.take_sample(next.x, next.y, next.sample, next.taken);
            packet.place = select(next.taken, next.place, packet.place);
        }
    }

    /// Advances all paths by one vertex, and keeps the radiance of those that end. False if there was no path.
    template <class Tracer>
    TANDEM_HD_INLINE bool step(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                               SampleSets<Real>& samples, TileStats& stats) {
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
                if (!any(ended)) continue;
                walk.stop(ended);
                keep(walk.radiance(), now_[i].place, ended, samples, stats);
            }
        }
        stats.add(tally);
        return true;
    }

  private:
    using Word = UInt<Real>;
    using Walk = PathWalk<Effects, Real>;
    static constexpr int packet_count = pick_packets;
    static constexpr int path_count = packet_count * Real::size;

    struct Packet {
        Walk walk;
        Closest<Real> hit = no_hit<Real>();
        Word place = Word(0U);  ///< of the radiance

        TANDEM_HD_INLINE auto per_lane() {
            return std::tuple_cat(std::tie(hit.t, hit.primitive, place), walk.per_lane());
        }
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
        const bool has_masks = scene.masked_kinds != 0;
        const bool shares_light =
            scene.area_light_count > 0 && (scene.indirect_light != 0 || has_material_parts(scene));
        for (int i = 0; i < packet_count; ++i) {
            Word path;
            std::memcpy(&path, from + i * Real::size, sizeof(path));
            fetch(path, next_[i].per_lane(), now_[0].per_lane());
            if (has_masks) fetch(path, next_[i].walk.per_lane_of_masks(), now_[0].walk.per_lane_of_masks());
            if (shares_light) fetch(path, next_[i].walk.per_lane_of_lights(), now_[0].walk.per_lane_of_lights());
        }
        std::swap(now_, next_);
    }

    /// `to`, `from`: references to values of the packet and of the first one.
    template <class Values>
    TANDEM_HD_INLINE static void fetch(const Word& path, Values to, Values from) {
        [&]<std::size_t... i>(std::index_sequence<i...>) {
            ((std::get<i>(to) = pick<sizeof(Packet)>(std::get<i>(from), path)), ...);
        }
        (std::make_index_sequence<std::tuple_size_v<Values>>());
    }

    TANDEM_HD_INLINE static void keep(const Vec3<Real>& radiance, const Word& place, const Mask<Real>& ended,
                                      SampleSets<Real>& samples, TileStats& stats) {
        const Addend<Real> addend = addend_of(radiance);
        samples.keep(place, to_wide(addend.radiance), ended);
        stats.counters.invalid_samples +=
            static_cast<std::uint64_t>(std::popcount((ended && !addend.is_number).bits()));
    }

    Packet memory_[2][packet_count];
    Packet* now_ = memory_[0];
    Packet* next_ = memory_[1];
};

}  // namespace tandem
