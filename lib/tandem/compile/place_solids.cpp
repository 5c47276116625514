#include "tandem/compile/place_solids.h"

#include <algorithm>
#include <cmath>

#include "tandem/base/error.h"
#include "tandem/base/large_array.h"
#include "tandem/base/parallel.h"
#include "tandem/compile/node_checks.h"
#include "tandem/compile/prepare_textures.h"

namespace tandem {

namespace {

constexpr std::size_t solids_at_once = 1U << 14;

/// Relative deviation up to which a linear map counts as a rotation times a uniform scale. A unit quaternion from a
/// file gives 1e-16; such a deviation moves a surface far less than the rounding of its centre to float.
constexpr double similarity_tolerance = 1e-12;

/// The uniform scale of `m`, or 0 if the scale is not uniform.
double uniform_scale(const Matrix3& m) {
    const Matrix3 columns = transpose(m);
    const double length2 = dot(columns.row[0], columns.row[0]);
    const double tolerance = similarity_tolerance * length2;
    const bool same = std::abs(dot(columns.row[1], columns.row[1]) - length2) <= tolerance &&
                      std::abs(dot(columns.row[2], columns.row[2]) - length2) <= tolerance;
    const bool right_angled = std::abs(dot(columns.row[0], columns.row[1])) <= tolerance &&
                              std::abs(dot(columns.row[1], columns.row[2])) <= tolerance &&
                              std::abs(dot(columns.row[2], columns.row[0])) <= tolerance;
    return same && right_angled ? std::sqrt(length2) : 0;
}

bool is_diagonal(const Matrix3& m) {
    return m.row[0].y == 0 && m.row[0].z == 0 && m.row[1].x == 0 && m.row[1].z == 0 && m.row[2].x == 0 &&
           m.row[2].y == 0;
}

/// Whether the map is a scale without mirroring.
bool is_upright(const Matrix3& m) { return is_diagonal(m) && m.row[0].x >= 0 && m.row[1].y >= 0 && m.row[2].z >= 0; }

/// Whether a solid whose size is not zero in float becomes smaller than any float under its transform.
bool vanishes_in_float(double size, double transformed) { return narrow(size) > 0 && !(narrow(transformed) > 0); }

// The solids in world space, double: at(origin) moves one to the origin of render space and rounds it to float.

struct Ball {
    static constexpr int kind = PrimitiveKinds::sphere_place;
    Vec3d centre;
    double radius;

    static auto& array(PreparedScene& scene) { return scene.spheres; }
    void add_to(RenderOrigin& origin) const { origin.add_sphere(centre, radius); }
    [[nodiscard]] Sphere at(const Vec3d& origin) const { return {narrow(centre - origin), narrow(radius)}; }
};

struct Block {
    static constexpr int kind = PrimitiveKinds::box_place;
    Vec3d centre;
    Vec3d extent;  ///< half of the edges

    static auto& array(PreparedScene& scene) { return scene.boxes; }
    void add_to(RenderOrigin& origin) const { origin.add_box(centre - extent, centre + extent); }
    [[nodiscard]] Box at(const Vec3d& origin) const {
        const Vec3d moved = centre - origin;
        return {narrow(moved - extent), narrow(moved + extent)};
    }
};

/// The unit sphere, or the cube [-1, 1]^3, in world space.
struct Placed {
    Transform world_from_unit;
    Matrix3 unit_from_world;
};

Placement place_body(const Placed& body, const Vec3d& origin, bool is_box) {
    const Matrix3& m = body.world_from_unit.linear;
    Placement placement;
    placement.object_from_world = body.unit_from_world;
    placement.centre = body.world_from_unit.translation - origin;
    const auto extent = [&](const Vec3d& row) {
        // support of the solid along a world axis: l1 norm for the cube, l2 for the ball
        const double support = is_box ? norm1(row) : std::sqrt(dot(row, row));
        return support * (1 + 1e-15);
    };
    placement.half_extent = {extent(m.row[0]), extent(m.row[1]), extent(m.row[2])};
    const Vec3f centre = narrow(placement.centre);
    const Vec3d moved = placement.centre - widen(centre);
    // the farthest point of the solid from its centre, and the rounding of the centre
    double radius = 0;
    if (is_box) {
        const Matrix3 c = transpose(m);
        for (int corner = 0; corner < 4; ++corner) {
            const Vec3d p = c.row[0] + c.row[1] * (corner & 1 ? 1.0 : -1.0) + c.row[2] * (corner & 2 ? 1.0 : -1.0);
            radius = std::max(radius, std::sqrt(dot(p, p)));
        }
    } else {
        // the Frobenius norm bounds the largest singular value
        radius = std::sqrt(dot(m.row[0], m.row[0]) + dot(m.row[1], m.row[1]) + dot(m.row[2], m.row[2]));
    }
    placement.bounding_sphere = {centre, round_up((radius + std::sqrt(dot(moved, moved))) * (1 + 1e-15))};
    return placement;
}

struct PlacedBall : Placed {
    static constexpr int kind = PrimitiveKinds::ellipsoid_place;
    static constexpr bool is_box = false;

    static auto& array(PreparedScene& scene) { return scene.ellipsoids; }
    void add_to(RenderOrigin& origin) const { origin.add_placed(world_from_unit, unit_from_world, is_box); }
    [[nodiscard]] Ellipsoid at(const Vec3d& origin) const { return {place_body(*this, origin, is_box)}; }
};

struct PlacedBox : Placed {
    static constexpr int kind = PrimitiveKinds::parallelepiped_place;
    static constexpr bool is_box = true;

    static auto& array(PreparedScene& scene) { return scene.parallelepipeds; }
    void add_to(RenderOrigin& origin) const { origin.add_placed(world_from_unit, unit_from_world, is_box); }
    [[nodiscard]] Parallelepiped at(const Vec3d& origin) const { return {place_body(*this, origin, is_box)}; }
};

/// Stands for a solid that is left out.
struct Dropped {};

/// Why a solid cannot be placed.
struct SolidError : InputError {
    SolidError(const InputError& error, const Geometry* of) : InputError(error), geometry(of) {}
    const Geometry* geometry;
};

}  // namespace

Solids::Solids(const Scene& scene, std::span<const Transform> world_from_node, const PreparedScene& prepared)
    : scene_(scene), world_from_node_(world_from_node), prepared_(prepared) {
    list_parts();
    try {
        find();
    } catch (const SolidError& error) {
        failure_ = std::make_exception_ptr(InputError(error));
        failed_ = error.geometry;
    }
}

void Solids::check(const Geometry& geometry) const {
    if (failed_ == &geometry) std::rethrow_exception(failure_);
}

std::size_t Solids::count() const {
    std::size_t count = 0;
    for (const Tally& tally : tallies_) {
        for (const std::size_t of_kind : tally.count) count += of_kind;
    }
    return count;
}

std::uint64_t Solids::dropped() const {
    std::uint64_t dropped = 0;
    for (const Tally& tally : tallies_) dropped += tally.dropped;
    return dropped;
}

void Solids::add_to(RenderOrigin& origin) const {
    for (std::size_t kind = 0; kind < kinds; ++kind) {
        for (const Tally& tally : tallies_) origin.add(tally.origin[kind]);
    }
}

void Solids::list_parts() {
    const std::vector<bool>& masked_out = prepared_.textures.is_masked_out;
    for (std::size_t node = 0; node < scene_.nodes.size(); ++node) {
        for (const Geometry& geometry : scene_.nodes[node].geometry) {
            if (std::holds_alternative<MeshShape>(geometry.shape)) continue;
            const bool is_masked_out = !masked_out.empty() && masked_out[geometry.material];
            parts_.push_back({{&geometry, node, solids_}, is_masked_out, has_orientation(geometry.material)});
            solids_ += instance_count(geometry);
        }
    }
}

void Solids::find() {
    const Vec3d camera = prepared_.camera.render_from_camera.translation;
    const RenderOrigin none(camera);
    tallies_.assign(chunk_count(solids_, solids_at_once), Tally{{none, none, none, none}});
    for_each_chunk(solids_, solids_at_once, [&](const Chunk& chunk) {
        Tally tally = tallies_[chunk.number];  // not in place: threads would share cache lines
        visit_range(chunk.begin, chunk.end, [&]<class Solid>(const Part&, const Solid& solid) {
            if constexpr (std::is_same_v<Solid, Dropped>) {
                ++tally.dropped;
            } else {
                ++tally.count[Solid::kind];
                solid.add_to(tally.origin[Solid::kind]);
            }
        });
        tallies_[chunk.number] = tally;
    });
}

void Solids::place(const Vec3d& origin, std::size_t faces, PreparedScene& result) const {
    // by chunk and kind, where the first solid goes in the array of its kind; then by kind alone, how many there are
    std::vector<std::array<std::size_t, kinds>> first(tallies_.size() + 1);
    for (std::size_t chunk = 0; chunk < tallies_.size(); ++chunk) {
        for (std::size_t kind = 0; kind < kinds; ++kind) {
            first[chunk + 1][kind] = first[chunk][kind] + tallies_[chunk].count[kind];
        }
    }
    const std::array<std::size_t, kinds>& counts = first.back();
    const std::size_t all = count();
    make_large(result.spheres, counts[Ball::kind], counts[Ball::kind]);
    make_large(result.boxes, counts[Block::kind], counts[Block::kind]);
    make_large(result.ellipsoids, counts[PlacedBall::kind], counts[PlacedBall::kind]);
    make_large(result.parallelepipeds, counts[PlacedBox::kind], counts[PlacedBox::kind]);
    make_large(result.material_of, all, all + faces);
    make_large(result.node_of, all, all + faces);
    std::array<std::size_t, kinds> first_id{};
    for (std::size_t kind = 1; kind < kinds; ++kind) first_id[kind] = first_id[kind - 1] + counts[kind - 1];
    std::uint32_t* const material_of = result.material_of.data();
    std::uint32_t* const node_of = result.node_of.data();
    for_each_chunk(solids_, solids_at_once, [&](const Chunk& chunk) {
        std::array<std::size_t, kinds> next = first[chunk.number];
        visit_range(chunk.begin, chunk.end, [&]<class Solid>(const Part& part, const Solid& solid) {
            if constexpr (!std::is_same_v<Solid, Dropped>) {
                const std::size_t number = next[Solid::kind]++, id = first_id[Solid::kind] + number;
                Solid::array(result)[number] = solid.at(origin);
                material_of[id] = part.geometry->material;
                node_of[id] = static_cast<std::uint32_t>(part.node);
            }
        });
    });
}

/// Spheres and boxes have the axes of the world; a picture that is turned or mirrored needs its own, and so do the
/// grooves of a brushed surface.
bool Solids::has_orientation(std::uint32_t material) const {
    const bool is_brushed = !prepared_.anisotropies.empty() && prepared_.microfacets[material].anisotropy > 0;
    bool has_picture = has_texture(prepared_.textures, material);
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) \
    has_picture = has_picture || (!prepared_.names.empty() && prepared_.names[material].texture != no_texture);
#include "tandem/kernel/bsdf/lobes.def"
    return is_brushed || has_picture;
}

/// Calls sink(part, solid) for the solids of these numbers, in their order. Throws SolidError at the first that cannot
/// be placed.
template <class Sink>
void Solids::visit_range(std::size_t begin, std::size_t end, const Sink& sink) const {
    visit_instances(parts_, world_from_node_, begin, end, [&](const Part& part, const Transform& world_from_object) {
        try {
            visit(part, world_from_object, sink);
        } catch (const InputError& error) {
            throw SolidError(error, part.geometry);
        }
    });
}

template <class Sink>
void Solids::visit(const Part& part, const Transform& world_from_object, const Sink& sink) const {
    if (part.is_masked_out || is_hidden(world_from_object.linear)) {
        sink(part, Dropped{});
    } else if (std::holds_alternative<SphereShape>(part.geometry->shape)) {
        visit_sphere(part, world_from_object, sink);
    } else {
        visit_box(part, world_from_object, sink);
    }
}

template <class Sink>
void Solids::visit_sphere(const Part& part, const Transform& world_from_object, const Sink& sink) const {
    const double r = std::get<SphereShape>(part.geometry->shape).radius;
    const double scale = uniform_scale(world_from_object.linear);
    if (!(scale > 0) || (part.has_orientation && !is_upright(world_from_object.linear))) {
        return visit_body<PlacedBall>(part, world_from_object, {r, r, r}, sink);
    }
    const double radius = scale * r;
    if (vanishes_in_float(r, radius)) return sink(part, Dropped{});
    if (!(narrow(radius) > 0)) {
        fail_at_node(scene_, part.node, "a sphere whose radius vanishes in float under the node's scale");
    }
    check_reach(scene_, part.node, world_from_object.translation, {radius, radius, radius});
    sink(part, Ball{world_from_object.translation, radius});
}

template <class Sink>
void Solids::visit_box(const Part& part, const Transform& world_from_object, const Sink& sink) const {
    const Vec3d half = std::get<BoxShape>(part.geometry->shape).size * 0.5;
    const Matrix3& m = world_from_object.linear;
    if (!is_diagonal(m) || (part.has_orientation && !is_upright(m))) {
        return visit_body<PlacedBox>(part, world_from_object, half, sink);
    }
    const Vec3d extent = {std::abs(m.row[0].x) * half.x, std::abs(m.row[1].y) * half.y, std::abs(m.row[2].z) * half.z};
    if (vanishes_in_float(norm1(half), norm1(extent))) return sink(part, Dropped{});
    check_reach(scene_, part.node, world_from_object.translation, extent);
    sink(part, Block{world_from_object.translation, extent});
}

/// `size`: scale from the unit solid to the shape.
template <class Body, class Sink>
void Solids::visit_body(const Part& part, const Transform& world_from_object, const Vec3d& size,
                        const Sink& sink) const {
    Transform world_from_unit = world_from_object;
    for (Vec3d& row : world_from_unit.linear.row) row = row * size;
    const double volume = std::abs(determinant(world_from_unit.linear));
    const Matrix3& m = world_from_unit.linear;
    if (vanishes_in_float(norm1(size), norm1(m.row[0]) + norm1(m.row[1]) + norm1(m.row[2]))) {
        return sink(part, Dropped{});
    }
    const double lengths = std::sqrt(dot(m.row[0], m.row[0]) * dot(m.row[1], m.row[1]) * dot(m.row[2], m.row[2]));
    // below this the inverse has no digits left; a NaN fails as well
    if (!(volume > 1e-12 * lengths) || !std::isnormal(volume)) {
        const char* flat_box = is_diagonal(m)
                                   ? "a mirrored box that is flat and has a texture or is brushed; give it thickness"
                                   : "a rotated or sheared box that is flat; give it thickness";
        fail_at_node(scene_, part.node, Body::is_box ? flat_box : "a sphere that its transform flattens");
    }
    check_reach(scene_, part.node, world_from_unit.translation, {norm1(m.row[0]), norm1(m.row[1]), norm1(m.row[2])});
    sink(part, Body{{world_from_unit, inverse(m)}});
}

}  // namespace tandem
