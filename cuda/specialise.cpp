#include "cuda/specialise.h"

#include <mutex>
#include <string_view>
#include <utility>

#include "tandem/base/seconds.h"
#include "tandem/base/sha256.h"

namespace tandem::cuda {

std::string cache_key(const JitInput& input, const std::string& version) {
    Sha256 hash;
    // each part is preceded by its length, so that no two inputs give the same bytes
    const auto add = [&](const void* data, std::size_t bytes) {
        hash.update_value(std::uint64_t{bytes});
        hash.update(data, bytes);
    };
    const auto add_text = [&](std::string_view text) { add(text.data(), text.size()); };
    add_text("tandem kernel 1");
    add_text(version);
    add(input.code.data(), input.code.size());
    add_text(input.facts_name);
    add(input.facts.data(), input.facts.size() * sizeof(std::uint32_t));
    for (const std::string& option : link_options(input)) add_text(option);  // tier, architecture, kernel
    return hash.hex();
}

Specialised specialise(const JitInput& input, const KernelCache& cache) {
    const Stopwatch watch;
    const std::string key = cache_key(input, jit_version());
    // several GPUs want the same kernel at once: one links it, the others find it in the cache
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    KernelCache::Found found = cache.find(key);
    Specialised result;
    result.cache_problem = std::move(found.problem);
    result.from_cache = !found.cubin.empty();
    if (result.from_cache) {
        result.cubin = std::move(found.cubin);
    } else {
        result.cubin = link(input);
        const std::string problem = cache.store(key, result.cubin);
        if (!problem.empty()) result.cache_problem = problem;
    }
    result.seconds = watch.seconds();
    return result;
}

}  // namespace tandem::cuda
