/// The BSDF of a surface: the sum of the lobes of bsdf/lobes.def. Lobes that a surface lacks are black; lobes that a
/// kernel does not simulate cost neither code nor state; lobes that no lane of a packet has cost a branch.
#pragma once

#include <type_traits>

#include "tandem/effects/effects.h"
#include "tandem/kernel/bsdf/lobes.h"

namespace tandem {

/// Which lobes of a packet at least one lane has, by the effects that they need. The others are undefined.
template <class Real, bool is_packet = (RealTraits<Real>::lanes > 1)>
class UsedLobes {
  public:
    [[nodiscard]] TANDEM_HD bool has(EffectMask needs) const { return is_always(needs) || effects_.has_any(needs); }
    TANDEM_HD void add(EffectMask needs) { effects_ |= needs; }
    TANDEM_HD void add(const UsedLobes& other) { effects_ |= other.effects_; }

  private:
    EffectMask effects_;
};

/// A single ray has all lobes, of which some are black. With branches, the threads of a GPU would wait for each other.
template <class Real>
class UsedLobes<Real, false> {
  public:
    [[nodiscard]] TANDEM_HD static constexpr bool has(EffectMask) { return true; }
    TANDEM_HD static constexpr void add(EffectMask) {}
    TANDEM_HD static constexpr void add(const UsedLobes&) {}
};

/// Made black by clear(). Tested by tests/kernel/surface_lobes_test.cpp.
template <class Real>
struct SurfaceLobes {
    UsedLobes<Real> used;
#define TANDEM_LOBE(Type, name, needs, follows, is) Type<Real> name;
#include "tandem/kernel/bsdf/lobes.def"
};

/// The index of each lobe in lobes.def.
struct LobePlace {
    enum Place : int {
#define TANDEM_LOBE(Type, name, needs, follows, is) name,
#include "tandem/kernel/bsdf/lobes.def"
        count
    };
};

namespace lobes_detail {

struct LobeUse {
    EffectMask needs, follows;
};
template <int place>
inline constexpr LobeUse use_of;
#define TANDEM_LOBE(Type, name, needs, follows, is) \
    template <>                                     \
    inline constexpr LobeUse use_of<LobePlace::name> = {needs, follows};
#include "tandem/kernel/bsdf/lobes.def"

}  // namespace lobes_detail

/// Whether the path loop evaluates a lobe in its local frame.
template <class Lobe, class Real>
inline constexpr bool is_local = !has(Lobe::flags, LobeFlags::specular) && !ReflectsInWorld<Lobe, Real>;

namespace lobes_detail {

struct LobeKind {
    LobeFlags flags;
    int numbers;
    bool local;
};

/// The union of one column of lobes.def over the lobes for which `is_meant`, without `always`.
constexpr EffectMask effects_of(EffectMask LobeUse::*column, bool (*is_meant)(LobeKind)) {
    EffectMask mask;
#define TANDEM_LOBE(Type, name, needs, follows, is)                                           \
    if ((use_of<LobePlace::name>.*column).bits() != always.bits() &&                          \
        is_meant({Type<float>::flags, Type<float>::numbers, is_local<Type<float>, float>})) { \
        mask |= use_of<LobePlace::name>.*column;                                              \
    }
#include "tandem/kernel/bsdf/lobes.def"
    return mask;
}

}  // namespace lobes_detail

/// The effects that need lobes, and those that need lobes in the local frame.
inline constexpr EffectMask effects_of_lobes =
    lobes_detail::effects_of(&lobes_detail::LobeUse::needs, [](lobes_detail::LobeKind) { return true; });
inline constexpr EffectMask effects_of_local_lobes =
    lobes_detail::effects_of(&lobes_detail::LobeUse::needs, [](lobes_detail::LobeKind kind) { return kind.local; });

/// The effects of kernels for paths that end at their first vertex. Sheen is not among them: glTF files need it only
/// beside microfacets, whose paths go on.
inline constexpr EffectMask direct_effects = all_effects - bouncing_effects - effects_of_local_lobes;

/// The effects for which paths follow lobes that count as reflections (PathLimits).
inline constexpr EffectMask effects_of_reflections = lobes_detail::effects_of(
    &lobes_detail::LobeUse::follows, [](lobes_detail::LobeKind kind) { return !has(kind.flags, LobeFlags::diffuse); });
static_assert(bouncing_effects.covers(lobes_detail::effects_of(&lobes_detail::LobeUse::follows,
                                                               [](lobes_detail::LobeKind) { return true; })),
              "paths follow a lobe for an effect that is none of bouncing_effects (effects/effects.h)");

// The effects for which paths follow glossy lobes, and lobes that are not specular.
inline constexpr EffectMask effects_of_glossy_lobes = lobes_detail::effects_of(
    &lobes_detail::LobeUse::follows, [](lobes_detail::LobeKind kind) { return has(kind.flags, LobeFlags::glossy); });
inline constexpr EffectMask effects_of_scattering_lobes = lobes_detail::effects_of(
    &lobes_detail::LobeUse::follows, [](lobes_detail::LobeKind kind) { return !has(kind.flags, LobeFlags::specular); });

namespace lobes_detail {

/// The number of glossy lobes before `end`.
constexpr int glossy_lobes_before(int end) {
    int count = 0;
#define TANDEM_LOBE(Type, name, needs, follows, is) \
    if (LobePlace::name < end && has(Type<float>::flags, LobeFlags::glossy)) ++count;
#include "tandem/kernel/bsdf/lobes.def"
    return count;
}

}  // namespace lobes_detail

/// Glossy lobes are numbered among themselves, from 0 to glossy_lobe_count - 1.
inline constexpr int glossy_lobe_count = lobes_detail::glossy_lobes_before(LobePlace::count);
template <int place>
inline constexpr int glossy_number = lobes_detail::glossy_lobes_before(place);

/// Calls visit(lobe, place) for each lobe that the kernel simulates and the surface has, in their order; `place` is a
/// constant of LobePlace.
template <class Effects, class Lobes, class Visit>
TANDEM_HD void for_each_lobe(Lobes& lobes, Visit visit) {
#define TANDEM_LOBE(Type, name, needs, follows, is)                            \
    if constexpr (can_simulate<Effects>(needs)) {                              \
        if (simulates<Effects>(needs) && lobes.used.has(needs)) {              \
            visit(lobes.name, std::integral_constant<int, LobePlace::name>{}); \
        }                                                                      \
    }
#include "tandem/kernel/bsdf/lobes.def"
}

/// Makes the lobes of a black surface: for a packet those that every surface has, since its lobes have kilobytes; for a
/// single ray all that the kernel simulates.
template <class Effects, class Real>
TANDEM_HD void clear(SurfaceLobes<Real>& lobes) {
    lobes.used = {};
    for_each_lobe<Effects>(lobes, [](auto& lobe, auto) { lobe = {}; });
}

/// Whether paths of any kernel continue along the lobe at `place`.
template <int place>
inline constexpr bool is_ever_followed = !lobes_detail::use_of<place>.follows.empty();

/// Whether paths of this kernel can continue along the lobe at `place`, at compile time.
template <class Effects, int place>
TANDEM_HD constexpr bool can_follow() {
    return can_simulate<Effects>(lobes_detail::use_of<place>.needs) &&
           can_simulate<Effects>(lobes_detail::use_of<place>.follows);
}

/// The same for each lobe along which paths continue.
template <class Effects, class Lobes, class Visit>
TANDEM_HD void for_each_followed_lobe(Lobes& lobes, Visit visit) {
    for_each_lobe<Effects>(lobes, [&](auto& lobe, auto place) {
        constexpr int at = decltype(place)::value;
        if constexpr (can_follow<Effects, at>()) {
            if (simulates<Effects>(lobes_detail::use_of<at>.follows)) visit(lobe, place);
        }
    });
}

/// A sum over lobes, in their order.
template <class T>
class LobeSum {
  public:
    /// `nothing`: the value of the empty sum.
    TANDEM_HD explicit LobeSum(const T& nothing) : sum_(nothing) {}
    TANDEM_HD void add(const T& addend) {
        if (empty_) {
            sum_ = addend;
        } else {
            sum_ = sum_ + addend;
        }
        empty_ = false;
    }
    [[nodiscard]] TANDEM_HD const T& value() const { return sum_; }

  private:
    T sum_;
    bool empty_ = true;  // so that 0 + x costs nothing
};

/// Replaces `kept` by `lobes` in the lanes of `mask`.
template <class Effects, class Real>
TANDEM_HD void keep(const Mask<Real>& mask, const SurfaceLobes<Real>& lobes, SurfaceLobes<Real>& kept) {
#define TANDEM_LOBE(Type, name, needs, follows, is)               \
    if constexpr (can_simulate<Effects>(needs)) {                 \
        if (simulates<Effects>(needs) && lobes.used.has(needs)) { \
            if (!kept.used.has(needs)) kept.name = {};            \
            kept.name = select(mask, lobes.name, kept.name);      \
        }                                                         \
    }
#include "tandem/kernel/bsdf/lobes.def"
    kept.used.add(lobes.used);
}

/// The lanes whose surface transmits light.
template <class Effects, class Real>
TANDEM_HD Mask<Real> transmits(const SurfaceLobes<Real>& lobes) {
    Mask<Real> result(false);
    for_each_lobe<Effects>(lobes, [&](const auto& lobe, auto) {
        if constexpr (has(std::decay_t<decltype(lobe)>::flags, LobeFlags::transmission)) {
            result = result || lobe.scatters();
        }
    });
    return result;
}

/// The lanes whose surface has a lobe that is not specular.
template <class Effects, class Real>
TANDEM_HD Mask<Real> scatters(const SurfaceLobes<Real>& lobes) {
    Mask<Real> result(false);
    for_each_lobe<Effects>(lobes, [&](const auto& lobe, auto) {
        if constexpr (!has(std::decay_t<decltype(lobe)>::flags, LobeFlags::specular)) {
            result = result || lobe.scatters();
        }
    });
    return result;
}

/// The same for lobes that work in the local frame.
template <class Effects, class Real>
TANDEM_HD Mask<Real> scatters_locally(const SurfaceLobes<Real>& lobes) {
    Mask<Real> result(false);
    for_each_lobe<Effects>(lobes, [&](const auto& lobe, auto) {
        if constexpr (is_local<std::decay_t<decltype(lobe)>, Real>) result = result || lobe.scatters();
    });
    return result;
}

}  // namespace tandem
