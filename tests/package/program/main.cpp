#include <iostream>

#include <tandem/tandem.h>

int main() {
    const auto scene = tandem::prepare_shared(tandem::named_scene("paper"), {.frame = 30});
    for (const std::string& name : tandem::backend_names()) {
        if (!tandem::why_unavailable(name).empty()) continue;  // no GPU here, for example
        const auto backend = tandem::make_backend(name);
        const auto result = backend->render(backend->load_shared(scene), {.width = 64, .height = 48, .samples = 4});
        std::cout << name << ' ' << tandem::film_hash(result.film) << '\n';
    }
}
