// Jobs that backends refuse.
#include "tandem/render/render_job.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/thrown_message.h"
#include "tandem/base/error.h"

namespace tandem {
namespace {

using test::thrown_message;

std::string refusal_of(const FilmWindow& window) {
    RenderJob job;
    job.width = 40;
    job.height = 30;
    job.window = window;
    return thrown_message<InputError>([&] { check(job); });
}

TEST(RenderJob, HasItsWindowWithinTheFilm) {
    for (const FilmWindow& good : {FilmWindow{0, 0, 40, 30}, FilmWindow{39, 29, 1, 1}, FilmWindow{7, 0, 33, 1}}) {
        EXPECT_EQ(refusal_of(good), "");
    }
    const int far = std::numeric_limits<int>::max();
    for (const FilmWindow& bad : {FilmWindow{0, 0, 41, 30}, FilmWindow{40, 0, 1, 1}, FilmWindow{-1, 0, 1, 1},
                                  FilmWindow{0, 30, 1, 1}, FilmWindow{3, 3, 0, 1}, FilmWindow{3, 3, 1, -5},
                                  FilmWindow{1, 0, far, 1}, FilmWindow{0, far, 1, far}, FilmWindow{0, 1, 40, 30}}) {
        EXPECT_NE(refusal_of(bad).find("within the film of 40 x 30"), std::string::npos) << refusal_of(bad);
    }
}

TEST(RenderJob, OfALargeFilmIsAllowedAWindow) {
    RenderJob job;
    job.width = job.height = 65536;
    EXPECT_NE(thrown_message<InputError>([&] { check(job); }).find("render windows of it"), std::string::npos);
    job.window = FilmWindow{65000, 65000, 500, 500};
    EXPECT_EQ(thrown_message<InputError>([&] { check(job); }), "");
}

}  // namespace
}  // namespace tandem
