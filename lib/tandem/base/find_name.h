/// Finds an entry of a table by its name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tandem/base/error.h"

namespace tandem {

/// The entry whose member `name` is `name`. Throws InputError that lists the names there are. `kind`: what the entries
/// are, as "sampler".
template <class Info>
[[nodiscard]] const Info& find_name(const std::vector<Info>& infos, std::string_view name, const std::string& kind) {
    std::string known;
    for (const Info& info : infos) {
        if (name == info.name) return info;
        known += (known.empty() ? "" : ", ") + std::string(info.name);
    }
    throw InputError("there is no " + kind + " '" + std::string(name) + "'; the " + kind + "s are " + known);
}

}  // namespace tandem
