/// Films of the oracle that several test cases compare with.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <string_view>

#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"

namespace tandem::test {

/// The oracle's film of a scene, rendered once per test suite: the instruction sets of a case that runs TOGETHER
/// (tests/CMakeLists.txt) share it. `name`: of the job; within a suite and a tier, jobs of one name must be equal.
inline const Film& film_of_the_oracle(const PreparedScene& scene, std::string_view name, const RenderJob& job) {
    static std::map<std::string, Film> films;
    const std::string suite = ::testing::UnitTest::GetInstance()->current_test_info()->test_suite_name();
    const auto [place, is_new] =
        films.try_emplace(suite + '\n' + std::string(name) + '\n' + to_string(job.tier) + '\n' + scene_hash(scene));
    if (is_new) {
        const auto oracle = make_backend("oracle");
        place->second = oracle->render(oracle->load(scene, job.tier), job).film;
    }
    return place->second;
}

}  // namespace tandem::test
