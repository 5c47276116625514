#include "tandem/render/specialise.h"

#include <fmt/format.h>

#include "tandem/base/error.h"

namespace tandem {

Specialise parse_specialise(const std::string& text) {
    if (text == "never") return Specialise::never;
    if (text == "always") return Specialise::always;
    throw InputError(fmt::format("kernels are specialised 'never' or 'always', not '{}'", text));
}

}  // namespace tandem
