#include "tandem/gltf/mend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tandem/gltf/faces.h"
#include "tandem/math/ray.h"

namespace tandem::gltf {

namespace {

bool is_number(const Vec3f& v) {
    const auto good = [](float x) { return std::abs(x) <= static_cast<float>(coordinate_limit); };  // not of a NaN
    return good(v.x) && good(v.y) && good(v.z);
}

class Mender {
  public:
    Mender(const Document& document, Mesh& mesh, const std::string& path, FlawLog& flaws)
        : document_(document), mesh_(mesh), path_(path), flaws_(flaws) {}

    void run() {
        mend_positions();
        mend_normals();
        for (std::size_t set = 0; set < mesh_.texcoords.size(); ++set) mend_texcoords(set);
    }

  private:
    [[nodiscard]] std::string attribute(const std::string& name) const {
        return fmt::format("{}.attributes.{}", path_, name);
    }

    void mend_positions() {
        const auto bad = std::find_if_not(mesh_.positions.begin(), mesh_.positions.end(), is_number);
        if (bad == mesh_.positions.end()) return;
        const std::string what =
            fmt::format("element {} has a number that is not finite or beyond 1e18", bad - mesh_.positions.begin());
        const std::size_t all = mesh_.triangles.size() / 3;
        const std::size_t removed = remove_triangles(
            mesh_.triangles, [this](std::uint32_t vertex) { return !is_number(mesh_.positions[vertex]); });
        if (removed == all) document_.fail(attribute("POSITION"), what);
        if (removed > 0) {
            flaws_.replace("triangles", attribute("POSITION"),
                           fmt::format("{}; Tandem leaves out {} of {} triangles", what, removed, all));
        }
        std::replace_if(
            mesh_.positions.begin(), mesh_.positions.end(), [](const Vec3f& p) { return !is_number(p); },
            Vec3f{0, 0, 0});
    }

    void mend_normals() {
        std::vector<Vec3f>& normals = mesh_.normals;
        const auto bad = std::find_if_not(normals.begin(), normals.end(), is_number);
        if (bad == normals.end()) return;
        flaws_.replace(
            "normals", attribute("NORMAL"),
            fmt::format("element {} has a number that is not finite or beyond 1e18; Tandem uses the mean normal "
                        "of the adjacent triangles",
                        bad - normals.begin()));
        std::vector<bool> is_bad(normals.size());
        for (std::size_t i = 0; i < normals.size(); ++i) is_bad[i] = !is_number(normals[i]);
        std::vector<Vec3d> sums(normals.size(), Vec3d{0, 0, 0});
        for (std::size_t i = 0; i < mesh_.triangles.size(); i += 3) {
            const std::uint32_t* corner = &mesh_.triangles[i];
            const auto at = [&](int k) { return widen(mesh_.positions[corner[k]]); };
            const Vec3d twice_area = cross(at(1) - at(0), at(2) - at(0));
            for (int k = 0; k < 3; ++k) sums[corner[k]] += twice_area;
        }
        for (std::size_t i = 0; i < normals.size(); ++i) {
            if (!is_bad[i]) continue;
            const double length = std::sqrt(dot(sums[i], sums[i]));
            const bool has_direction = length > 0 && std::isfinite(length);
            normals[i] = has_direction ? narrow(sums[i] * (1 / length)) : Vec3f{0, 0, 0};
        }
    }

    void mend_texcoords(std::size_t set) {
        const auto is_bad = [](const Vec2f& v) { return !std::isfinite(v.x) || !std::isfinite(v.y); };
        std::vector<Vec2f>& texcoords = mesh_.texcoords[set];
        const auto bad = std::find_if(texcoords.begin(), texcoords.end(), is_bad);
        if (bad == texcoords.end()) return;
        flaws_.replace(
            "texture coordinates", attribute(fmt::format("TEXCOORD_{}", set)),
            fmt::format("element {} has a number that is not finite; Tandem uses (0, 0)", bad - texcoords.begin()));
        std::replace_if(texcoords.begin(), texcoords.end(), is_bad, Vec2f{0, 0});
    }

    const Document& document_;
    Mesh& mesh_;
    const std::string& path_;
    FlawLog& flaws_;
};

}  // namespace

void mend(const Document& document, Mesh& mesh, const std::string& path, FlawLog& flaws) {
    Mender(document, mesh, path, flaws).run();
}

}  // namespace tandem::gltf
