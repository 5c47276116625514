#include "tandem/backends/backend_ahead.h"

#include <gtest/gtest.h>

#include "support/input_error.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

TEST(BackendAhead, RendersAsTheBackendItself) {
    const auto prepared = std::make_shared<PreparedScene>(prepare(named_scene("spheres/50")));
    const RenderJob job{24, 20, 2};
    for (const char* name : {"cpu", "oracle"}) {
        const auto direct = make_backend(name);
        const auto ahead = make_backend_ahead(name);
        EXPECT_EQ(ahead->name(), name);
        EXPECT_EQ(ahead->capabilities().description, direct->capabilities().description);
        const std::string hash = film_hash(direct->render(direct->load(*prepared), job).film);
        EXPECT_EQ(film_hash(ahead->render(ahead->load(*prepared), job).film), hash);
        EXPECT_EQ(film_hash(ahead->render(ahead->load_shared(prepared, job.tier), job).film), hash);
        const Film film = ahead->make_film(job.width, job.height, job.samples, job.planes);
        (void)ahead->submit_to(film, 0, 0, ahead->load(*prepared), job)->get();
        EXPECT_EQ(film_hash(film), hash);
        EXPECT_EQ(ahead->frames_in_flight(), direct->frames_in_flight());
    }
}

TEST(BackendAhead, EveryCallThrowsWhyThereIsNone) {
    const auto nothing = make_backend_ahead("abacus");
    EXPECT_NO_THROW(make_backend_ahead("oracle")->check_so_far());
    for (int i = 0; i < 2; ++i) {
        EXPECT_TRUE(test::contains(test::input_error([&] { (void)nothing->name(); }), "there is no backend 'abacus'"));
    }
}

/// The CPU backend keeps a shared scene; it must not need the caller's pointer, and copies must still be left out.
TEST(BackendAhead, ASharedSceneIsKept) {
    Scene scene = named_scene("spheres/50");
    const auto backend = make_backend("cpu");
    const RenderJob job{24, 20, 1};
    for (const bool has_copies : {false, true}) {
        if (has_copies) scene.nodes.push_back(scene.nodes.back());
        auto prepared = std::make_shared<PreparedScene>(prepare(scene));
        EXPECT_EQ(prepared->copies.empty(), !has_copies);
        const std::string hash = film_hash(backend->render(backend->load(*prepared), job).film);
        const auto resident = backend->load_shared(prepared, job.tier);
        const std::weak_ptr<PreparedScene> watched = prepared;
        prepared.reset();
        EXPECT_EQ(watched.expired(), has_copies) << "kept instead of a copy";
        EXPECT_EQ(film_hash(backend->render(resident, job).film), hash);
    }
}

}  // namespace
}  // namespace tandem
