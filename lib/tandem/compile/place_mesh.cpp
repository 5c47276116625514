#include "tandem/compile/place_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/scene/normal_matrix.h"

namespace tandem {

namespace {

class Placer {
  public:
    Placer(const Mesh& mesh, const Transform& world_from_object, FaceSides sides, const CornerSlots& slots,
           PreparedScene& scene)
        : mesh_(mesh),
          normal_matrix_(normal_matrix(world_from_object.linear)),
          mirrors_(determinant(world_from_object.linear) < 0),
          sides_(sides),
          slots_(slots),
          scene_(scene) {
        world_.reserve(mesh.positions.size());
        for (const Vec3f& position : mesh.positions) {
            world_.push_back(place_corner(world_from_object, position));
            placed_.bounds = merge(placed_.bounds, {world_.back(), world_.back()});
        }
    }

    PlacedMesh run() {
        for (std::size_t i = 0; i < mesh_.triangles.size(); i += 3) add(corners<3>(&mesh_.triangles[i]));
        for (std::size_t i = 0; i < mesh_.quads.size(); i += 4) add(corners<4>(&mesh_.quads[i]));
        return placed_;
    }

  private:
    template <std::size_t count>
    using Corners = std::array<std::uint32_t, count>;

    template <std::size_t count>
    Corners<count> corners(const std::uint32_t* indices) const {
        Corners<count> result;
        std::copy_n(indices, count, result.begin());
        if (mirrors_) std::reverse(result.begin() + 1, result.end());  // the diagonal of a quad stays
        return result;
    }

    bool is_flat(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return is_degenerate(world_[a], world_[b], world_[c]);
    }

    void add(const Corners<3>& c) {
        if (is_flat(c[0], c[1], c[2])) {
            ++scene_.dropped_primitives;
            return;
        }
        scene_.triangles.push_back({world_[c[0]], world_[c[1]], world_[c[2]], attributes(c)});
        ++placed_.triangles;
    }

    void add(const Corners<4>& c) {
        if (is_flat(c[0], c[1], c[2])) return add(Corners<3>{c[0], c[2], c[3]});
        if (is_flat(c[0], c[2], c[3])) return add(Corners<3>{c[0], c[1], c[2]});
        scene_.quads.push_back({world_[c[0]], world_[c[1]], world_[c[2]], world_[c[3]], attributes(c)});
        ++placed_.quads;
    }

    template <std::size_t count>
    FaceAttributes attributes(const Corners<count>& c) {
        FaceAttributes result;
        result.sides = sides_;
        if (!mesh_.normals.empty()) {
            result.normals = next_index(scene_.normals.size());
            for (const std::uint32_t i : c) {
                scene_.normals.push_back(place_normal(normal_matrix_, mesh_.normals[i]));
            }
        }
        if (!slots_.empty()) {
            result.texcoords = next_index(scene_.texcoords.size());
            for (const std::uint32_t set : slots_.texcoords) add_texcoords(set, c);
            if (slots_.has_colours) add_colours(c);
        }
        return result;
    }

    template <std::size_t count>
    void add_texcoords(std::uint32_t set, const Corners<count>& c) {
        const bool has_set = set < mesh_.texcoords.size() && !mesh_.texcoords[set].empty();
        for (const std::uint32_t i : c) scene_.texcoords.push_back(has_set ? mesh_.texcoords[set][i] : Vec2f{0, 0});
    }

    template <std::size_t count>
    void add_colours(const Corners<count>& c) {
        const auto colour = [&](std::uint32_t i) { return mesh_.colours.empty() ? VertexColour{} : mesh_.colours[i]; };
        for (const std::uint32_t i : c) scene_.texcoords.push_back({colour(i).rgb.x, colour(i).rgb.y});
        for (const std::uint32_t i : c) scene_.texcoords.push_back({colour(i).rgb.z, colour(i).alpha});
    }

    static std::uint32_t next_index(std::size_t size) {
        if (size > no_attributes - 4) {
            throw InputError(
                "the meshes of the scene have more than 4 billion values at the corners of faces; split the scene");
        }
        return static_cast<std::uint32_t>(size);
    }

    const Mesh& mesh_;
    Matrix3 normal_matrix_;
    bool mirrors_;
    FaceSides sides_;
    const CornerSlots& slots_;
    PreparedScene& scene_;
    std::vector<Vec3f> world_;
    PlacedMesh placed_;
};

}  // namespace

PlacedMesh place_mesh(const Mesh& mesh, const Transform& world_from_object, FaceSides sides, const CornerSlots& slots,
                      PreparedScene& scene) {
    return Placer(mesh, world_from_object, sides, slots, scene).run();
}

bool hides_backs(const Mesh& mesh, std::uint32_t material, const PreparedScene& scene) {
    return mesh.is_closed && !has_alpha_mask(view(scene), material);
}

Aabb bounds_of(const Mesh& mesh, const Transform& world_from_object) {
    Aabb bounds;
    for (const Vec3f& position : mesh.positions) {
        const Vec3f placed = place_corner(world_from_object, position);
        bounds = merge(bounds, {placed, placed});
    }
    return bounds;
}

}  // namespace tandem
