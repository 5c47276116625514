/// The effects that kernels can simulate, as bits; effects.def lists them.
#pragma once

#include <cstdint>

#include "tandem/math/host_device.h"

namespace tandem {

enum class Effect : std::uint32_t {
#define TANDEM_EFFECT(name, adds) name,
#include "tandem/effects/effects.def"
};

inline constexpr std::uint32_t effect_count = 0
#define TANDEM_EFFECT(name, adds) +1
#include "tandem/effects/effects.def"
    ;

/// A set of effects.
class EffectMask {
  public:
    constexpr EffectMask() = default;
    TANDEM_HD constexpr EffectMask(Effect effect) : bits_(1U << static_cast<std::uint32_t>(effect)) {}
    TANDEM_HD static constexpr EffectMask from_bits(std::uint32_t bits) {
        EffectMask mask;
        mask.bits_ = bits;
        return mask;
    }

    [[nodiscard]] TANDEM_HD constexpr std::uint32_t bits() const { return bits_; }
    [[nodiscard]] TANDEM_HD constexpr bool has(Effect effect) const { return (bits_ & EffectMask(effect).bits_) != 0; }
    [[nodiscard]] TANDEM_HD constexpr bool has_any(EffectMask of) const { return (bits_ & of.bits_) != 0; }
    [[nodiscard]] TANDEM_HD constexpr bool covers(EffectMask other) const { return (other.bits_ & ~bits_) == 0; }
    [[nodiscard]] TANDEM_HD constexpr bool empty() const { return bits_ == 0; }

    TANDEM_HD friend constexpr EffectMask operator|(EffectMask a, EffectMask b) { return from_bits(a.bits_ | b.bits_); }
    TANDEM_HD friend constexpr EffectMask operator&(EffectMask a, EffectMask b) { return from_bits(a.bits_ & b.bits_); }
    /// The effects in `a` that are not in `b`.
    TANDEM_HD friend constexpr EffectMask operator-(EffectMask a, EffectMask b) {
        return from_bits(a.bits_ & ~b.bits_);
    }
    TANDEM_HD constexpr EffectMask& operator|=(EffectMask other) { return *this = *this | other; }
    friend constexpr bool operator==(EffectMask, EffectMask) = default;

  private:
    std::uint32_t bits_ = 0;
};

TANDEM_HD constexpr EffectMask operator|(Effect a, Effect b) { return EffectMask(a) | EffectMask(b); }

inline constexpr EffectMask all_effects = EffectMask::from_bits((1U << effect_count) - 1);

/// A set that is known when a kernel is compiled: effects outside it leave no code. Kernels call has() of the type.
/// Another type may know its set only at link time (cuda/linked_facts.h); `most` is then the largest possible set.
template <std::uint32_t bits>
struct EffectSet {
    static constexpr EffectMask most = EffectMask::from_bits(bits);
    [[nodiscard]] TANDEM_HD static constexpr bool has(Effect effect) { return most.has(effect); }
    [[nodiscard]] TANDEM_HD static constexpr bool has_any(EffectMask of) { return most.has_any(of); }
    /// A fact about a scene or a job; a constant in a kernel that is linked for it.
    [[nodiscard]] TANDEM_HD static constexpr std::uint32_t light_count(std::uint32_t count) { return count; }
    template <class T>
    [[nodiscard]] TANDEM_HD static constexpr const T& limits(const T& limits) {
        return limits;
    }
};

// Values that tables of lobes and lights may have in place of effects.
inline constexpr EffectMask always = EffectMask::from_bits(~0U);
inline constexpr EffectMask never;

TANDEM_HD constexpr bool is_always(EffectMask mask) { return mask.bits() == always.bits(); }

/// Whether a kernel of this type can simulate one of these effects.
template <class Effects>
TANDEM_HD constexpr bool can_simulate(EffectMask any_of) {
    return Effects::most.has_any(any_of) || is_always(any_of);
}

/// Whether it simulates one of these effects.
template <class Effects>
TANDEM_HD constexpr bool simulates(EffectMask any_of) {
    return Effects::has_any(any_of) || is_always(any_of);
}

/// The effects that continue a path beyond its first vertex.
inline constexpr EffectMask bouncing_effects = EffectMask()
#define TANDEM_BOUNCING_EFFECT(name, adds) | Effect::name
#include "tandem/effects/effects.def"
    ;

/// The effects that send rays from surfaces: without them there is one ray per sample.
inline constexpr EffectMask counted_ray_effects = bouncing_effects | Effect::shadows;

/// Whether paths can continue beyond their first vertex, as known from the type.
template <class Effects>
TANDEM_HD constexpr bool can_bounce() {
    return Effects::most.has_any(bouncing_effects);
}

/// Whether paths continue beyond their first vertex.
template <class Effects>
TANDEM_HD constexpr bool has_bounces() {
    return Effects::has_any(bouncing_effects);
}

}  // namespace tandem
