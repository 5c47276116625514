/// The backends that guarantee equal bits, one test parameter each.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "support/compiled_tiers.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem::test {

/// One way to render: a backend, an exact tier and, for the CPU, an instruction set.
struct Renderer {
    std::string backend;
    BackendOptions options;
    Tier tier = Tier::strict;
};

inline void PrintTo(const Renderer& renderer, std::ostream* out) {
    *out << renderer.backend << " " << renderer.options.instruction_set << " " << to_string(renderer.tier);
}

[[nodiscard]] inline std::vector<Renderer> exact_renderers() {
    std::vector<Renderer> list;
    for (const Tier tier : {Tier::strict, Tier::precise}) {
        for (const char* set : {"x86-64-v2", "x86-64-v3", "x86-64-v4"}) {
            BackendOptions options;
            options.instruction_set = set;
            list.push_back({"cpu", options, tier});
        }
        BackendOptions ahead_of_time;  // tests/agree/specialised_test.cpp links kernels
        ahead_of_time.specialise = without_waiting(tier);
        list.push_back({"cuda", ahead_of_time, tier});
    }
    return list;
}

/// "cpu_x86_64_v3_strict", "cuda_precise": names for gtest.
[[nodiscard]] inline std::string test_name(const ::testing::TestParamInfo<Renderer>& info) {
    std::string name = info.param.backend;
    if (!info.param.options.instruction_set.empty()) name += "_" + info.param.options.instruction_set;
    name += "_" + to_string(info.param.tier);
    for (char& c : name) {
        if (c == '-') c = '_';
    }
    return name;
}

/// A fixture that has the backend, or skips with the reason why this machine cannot run it.
class ExactBackend : public ::testing::TestWithParam<Renderer> {
  protected:
    void SetUp() override {
        const std::string reason = why_unavailable(GetParam().backend);
        if (!reason.empty()) GTEST_SKIP() << GetParam().backend << ": " << reason;
        try {
            backend_ = make_backend(GetParam().backend, GetParam().options);
        } catch (const std::exception& error) {
            if (GetParam().options.instruction_set.empty()) throw;
            GTEST_SKIP() << error.what();
        }
    }
    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene& scene) {
        return backend_->load(scene, GetParam().tier);
    }
    std::unique_ptr<Backend> backend_;
};

}  // namespace tandem::test
