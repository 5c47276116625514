// A packet keeps only the lobes that one of its lanes has, and says in which lanes a path continues by chance.
#include "tandem/kernel/surface_lobes.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tandem/kernel/lobe_choice.h"
#include "tandem/math/lanes.h"

namespace tandem {
namespace {

using Packet = Lanes<float, Sse4>;
using AllEffects = EffectSet<all_effects.bits()>;

Mask<Packet> only(int lane) {
    const float numbers[] = {0, 1, 2, 3};
    Packet number;
    std::memcpy(&number, numbers, sizeof number);
    return number <= Packet(static_cast<float>(lane)) && number >= Packet(static_cast<float>(lane));
}

/// A lobe of all lanes, as a material makes it.
SurfaceLobes<Packet> with_sheen() {
    SurfaceLobes<Packet> lobes;
    clear<AllEffects>(lobes);
    lobes.used.add(Effect::sheen);
    lobes.sheen = {white<Packet>(), Packet(0.5F)};
    return lobes;
}
SurfaceLobes<Packet> with_mirror() {
    SurfaceLobes<Packet> lobes;
    clear<AllEffects>(lobes);
    lobes.used.add(Effect::reflection);
    lobes.mirror.reflectance = white<Packet>();
    return lobes;
}

TEST(SurfaceLobesOfAPacket, AreBlackInTheLanesOfOtherMaterials) {
    SurfaceLobes<Packet> kept;
    std::memset(static_cast<void*>(&kept), 0xFF, sizeof kept);  // NaN, as undefined lobes may be
    clear<AllEffects>(kept);
    keep<AllEffects>(only(1), with_sheen(), kept);
    EXPECT_TRUE(kept.used.has(Effect::sheen));
    EXPECT_FALSE(kept.used.has(Effect::reflection)) << "no lane has a mirror yet";
    keep<AllEffects>(only(2), with_mirror(), kept);
    EXPECT_TRUE(kept.used.has(Effect::sheen) && kept.used.has(Effect::reflection));
    EXPECT_FALSE(kept.used.has(Effect::refraction) || kept.used.has(Effect::microfacets));
    for (int i = 0; i < Packet::size; ++i) {
        EXPECT_EQ(kept.sheen.tint.x[i], i == 1 ? 1.0F : 0.0F) << i;
        EXPECT_EQ(kept.mirror.reflectance.x[i], i == 2 ? 1.0F : 0.0F) << i;
        EXPECT_EQ(kept.diffuse.reflectance.x[i], 0.0F) << i << ": every surface has this lobe";
    }
    int visited = 0;
    for_each_lobe<AllEffects>(kept, [&](const auto&, auto) { ++visited; });
    EXPECT_EQ(visited, 4) << "sheen, mirror, and the two lobes of every surface";
}

TEST(SurfaceLobesOfARay, AreAllThereAndBlack) {
    SurfaceLobes<float> lobes;
    clear<AllEffects>(lobes);
    int visited = 0;
    for_each_lobe<AllEffects>(lobes, [&](const auto& lobe, auto) {
        ++visited;
        EXPECT_FALSE(lobe.scatters()) << visited;
    });
    EXPECT_EQ(visited, static_cast<int>(LobePlace::count));
}

TEST(Choice, IsOfLanesWithSeveralLobesOrGlass) {
    Surface<Packet> surface;
    clear<AllEffects>(surface.reflectance.lobes);
    for (const Effect effect : {Effect::reflection, Effect::refraction}) surface.reflectance.lobes.used.add(effect);
    LobeWeights<Packet> weights;
    for (Packet& weight : weights.of) weight = Packet(0.0F);
    // lane 0: nothing; 1: a mirror alone; 2: glass alone; 3: a mirror on a diffuse surface
    const Packet one(1.0F), zero(0.0F);
    weights.of[LobePlace::mirror] = select(only(1) || only(3), one, zero);
    weights.of[LobePlace::dielectric] = select(only(2), one, zero);
    weights.of[LobePlace::diffuse] = select(only(3), one, zero);
    weights.of[LobePlace::sheen] = one;  // of no lane: not read
    const Mask<Packet> chooses = has_choice<AllEffects>(surface, weights);
    for (int i = 0; i < Packet::size; ++i) EXPECT_EQ(chooses[i], i >= 2) << i;
}

template <Effect effect>
using Only = EffectSet<EffectMask(effect).bits()>;

TEST(ChoiceOfARay, IsThatOfItsKernelWhateverTheSurface) {
    Surface<float> surface;
    LobeWeights<float> weights{};
    EXPECT_TRUE(has_choice<AllEffects>(surface, weights));
    EXPECT_FALSE(has_choice<Only<Effect::reflection>>(surface, weights));
    EXPECT_FALSE(has_choice<Only<Effect::indirect>>(surface, weights));
    EXPECT_TRUE(has_choice<Only<Effect::refraction>>(surface, weights)) << "a dielectric reflects by chance";
}

}  // namespace
}  // namespace tandem
