/// A small backend for tests: the shared kernels in a plain loop, exact, on one thread. It can be told to spoil its
/// pictures and its hits.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "backend_source.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem::bench {

class LoopScene final : public ResidentScene {
  public:
    LoopScene(PreparedScene scene, Tier tier) : ResidentScene(tier), prepared(std::move(scene)) {}
    [[nodiscard]] PhaseTimes load_times() const override { return {.build = 1e-4, .upload = 2e-4}; }

    PreparedScene prepared;
};

class LoopBackend final : public Backend {
  public:
    LoopBackend(std::string name, bool spoiled, bool exact)
        : name_(std::move(name)), spoiled_(spoiled), exact_(exact) {}

    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] Capabilities capabilities() const override { return {"a loop", "for tests", exact_}; }
    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier) override {
        return std::make_shared<LoopScene>(scene, tier);
    }

    double trace(ResidentScene& scene, const TraceJob& job) override;
    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                       const RenderJob& job) override;

  private:
    std::string name_;
    bool spoiled_;
    bool exact_;
};

/// Backends of loops under the usual names. `spoils` says which of them draw another picture.
[[nodiscard]] inline BackendSource loop_source(
    std::function<bool(const std::string&, const BackendOptions&)> spoils = [](const std::string&,
                                                                               const BackendOptions&) { return false; },
    const std::string& missing = "") {
    BackendSource source;
    source.why_unavailable = [missing](const std::string& name) {
        return name == missing ? "it is left out in this test" : std::string();
    };
    source.make = [spoils = std::move(spoils)](const std::string& name,
                                               const BackendOptions& options) -> std::unique_ptr<Backend> {
        return std::make_unique<LoopBackend>(name, spoils(name, options), name != "oracle");
    };
    return source;
}

/// Which backends loop_source() spoils.
[[nodiscard]] inline bool spoil_nothing(const std::string& /*name*/, const BackendOptions& /*options*/) {
    return false;
}
[[nodiscard]] inline bool spoil_the_gpu(const std::string& name, const BackendOptions& /*options*/) {
    return name == "cuda";
}

/// All callouts and paragraphs of a report, one after the other.
[[nodiscard]] inline std::string prose_of(const Report& report) {
    std::string text;
    for (const Block& block : report.blocks) {
        if (const auto* callout = std::get_if<Callout>(&block)) text += callout->text + "\n";
        if (const auto* paragraph = std::get_if<Paragraph>(&block)) text += paragraph->text + "\n";
    }
    return text;
}

/// A property of the report; empty if it is not there.
[[nodiscard]] inline std::string property_of(const Report& report, const std::string& name) {
    for (const auto& [key, value] : report.properties) {
        if (key == name) return value;
    }
    return {};
}

/// A figure of a row; the test fails if it is not there.
[[nodiscard]] inline double figure(const BenchmarkRow& row, const std::string& name) {
    for (const auto& [key, value] : row.figures) {
        if (key == name) return value;
    }
    ADD_FAILURE() << "no " << name;
    return 0;
}

}  // namespace tandem::bench
