#include "tandem/oracle/oracle_path.h"

#include <algorithm>
#include <cmath>

#include "tandem/oracle/oracle_environment.h"
#include "tandem/oracle/oracle_lights.h"
#include "tandem/oracle/oracle_media.h"

namespace tandem::oracle {

namespace {

/// The distance of a point from the camera along the view axis.
float depth_of(const CameraView& camera, const Vector& point) {
    const Vector right = to_vector(camera.orthographic ? camera.origin_dx : camera.direction_dx);
    const Vector down = to_vector(camera.orthographic ? camera.origin_dy : camera.direction_dy);
    const Vector axis = {down.y * right.z - down.z * right.y, down.z * right.x - down.x * right.z,
                         down.x * right.y - down.y * right.x};
    return static_cast<float>(std::abs(inner(point - to_vector(camera.origin), unit(axis))));
}

Vector mirrored(const Vector& d, const Vector& n) { return unit(d - n * (2 * inner(d, n))); }

}  // namespace

void add_first_hit(const BoundedView& scene, const CameraView& camera, const Line& camera_ray, bool is_first,
                   std::size_t pixel, const FilmPlanes& planes) {
    Passed passed;
    NearestSurface nearest;
    Vertex vertex{};
    do {
        nearest = nearest_surface(scene, camera_ray, {}, no_primitive, &passed);
        if (nearest.primitive != no_primitive) vertex = vertex_at(scene, camera_ray, nearest);
        passed = {nearest.surface.t, nearest.primitive};
    } while (nearest.primitive != no_primitive && vertex.is_masked_out);
    const bool hits = nearest.primitive != no_primitive;
    if (is_first && planes.depth != nullptr) planes.depth[pixel] = hits ? depth_of(camera, vertex.point) : HUGE_VALF;
    if (is_first && planes.primitive != nullptr) planes.primitive[pixel] = nearest.primitive;
    if (is_first && planes.material != nullptr) planes.material[pixel] = hits ? vertex.material : no_primitive;
    if (!hits) return;
    const auto add = [pixel](const Vector& value, Vec3d* plane) {
        if (plane == nullptr) return;
        plane[pixel] += Vec3d{static_cast<double>(value.x), static_cast<double>(value.y), static_cast<double>(value.z)};
    };
    add(albedo_of(scene, vertex), planes.albedo);
    add(vertex.normal, planes.normal);
}

Vector trace_path(const BoundedView& scene, const PathLimits& limits, const SampleId<float>& sample,
                  const Line& camera_ray) {
    Line ray = camera_ray;
    RaySource source;
    Passed passed;
    Vector radiance{0, 0, 0}, throughput{1, 1, 1};
    Media media(scene);
    std::uint32_t reflections = 0, refractions = 0, scatterings = 0;
    bool was_scattered = false;        // by a diffuse lobe, at the previous vertex
    bool lights_were_sampled = false;  // area lights were sampled at the previous vertex
    for (std::uint32_t vertex_number = 0;; ++vertex_number) {
        // Find the nearest surface, or end in the background
        const NearestSurface nearest = nearest_surface(scene, ray, source, no_primitive, &passed);
        if (nearest.primitive == no_primitive) {
            const bool shows = !was_scattered || scene.environment.illuminates != 0;
            const Vector seen = background_towards(scene, ray.direction);
            return shows ? radiance + times(throughput, seen) : radiance;
        }
        const Vertex vertex = vertex_at(scene, ray, nearest);
        const Optics& optics = scene.optics[vertex.material];
        const bool is_glass = optics.transmission > 0;

        // Absorb light along the segment
        const std::uint32_t own = is_glass && vertex.from_inside ? vertex.material : no_medium;
        const std::uint32_t medium = scene.media_overlap != 0 ? media.current() : own;
        if (medium != no_medium) {
            const Vector a = to_vector(scene.optics[medium].absorption);
            const Real distance = (nearest.surface.t - passed.t) * std::sqrt(inner(ray.direction, ray.direction));
            throughput =
                times(throughput, {std::exp(-a.x * distance), std::exp(-a.y * distance), std::exp(-a.z * distance)});
        }
        // Pass masked-out points
        if (vertex.is_masked_out) {
            passed = {nearest.surface.t, nearest.primitive};
            continue;
        }
        // Add emission, unless the previous vertex sampled this light
        const bool was_sampled =
            lights_were_sampled &&
            std::any_of(scene.area_lights, scene.area_lights + scene.area_light_count,
                        [&](const AreaLight& light) { return light.primitive == vertex.primitive; });
        const bool is_dark =
            was_sampled || (optics.unlit != 0 && was_scattered);  // unlit surfaces are not light sources
        if (vertex.shines && !is_dark) radiance = radiance + times(throughput, vertex.emission);
        // Add the reflected light of lights
        Chance chance(sample, vertex_number);
        const bool is_front = !(inner(vertex.direction, vertex.normal) > 0);
        const EndingLobes ends = {!is_front || scatterings >= limits.diffuse, reflections >= limits.reflection};
        radiance = radiance + times(throughput, shade(scene, vertex, ends, chance));

        // Choose a lobe
        const Reflectances material = reflectances(scene, vertex);
        const Real mirror = largest(to_vector(optics.mirror)), glass = optics.transmission;
        const Real lambert = scene.indirect_light != 0 && is_front ? most_scattered(material) : 0;
        const Real glossy =
            material.has_facets && !material.is_hidden ? std::max<Real>(largest(material.f0), Real(0.1)) : 0;
        if (!(mirror > 0) && !is_glass && !(lambert > 0) && !(glossy > 0)) return radiance;
        const auto random = sample.block(Dimension::scatter, vertex_number);
        const Real total = mirror + glass + lambert + glossy;
        const Real place = Real{to_unit_interval<float>(random.word[0])} * total;
        const bool takes_mirror = mirror > 0 && (place < mirror || (!is_glass && !(lambert > 0)));
        const bool takes_glass = !takes_mirror && is_glass && (place < mirror + glass || !(lambert > 0));
        const bool takes_glossy = glossy > 0 && (place < glossy || !(lambert > 0));
        const Vector facing = vertex.facet * (vertex.from_inside ? -1 : 1);
        const Vector normal = vertex.normal * (is_front ? 1 : -1);
        // Sample a direction and update the throughput
        bool through = false;
        was_scattered = !takes_mirror && !takes_glass && !takes_glossy;
        lights_were_sampled = was_scattered || (takes_glossy && samples_lights(material));
        Vector onward{};
        if (takes_glass) {
            Media behind = media;
            behind.cross(vertex.material, vertex.from_inside);
            const std::uint32_t other = is_glass && !vertex.from_inside ? vertex.material : no_medium;
            const Real from = index_of(scene, medium);
            const Real to = index_of(scene, scene.media_overlap != 0 ? behind.current() : other);
            Real reflectance = refract(vertex.direction, normal, from, to, onward);
            if (reflectance < 1 && !(inner(onward, facing) < 0)) {
                reflectance = refract(vertex.direction, facing, from, to, onward);
            }
            through = reflectance < 1 && !(to_unit_interval<float>(random.word[1]) < reflectance);
            if (through) media = behind;
            throughput = throughput * total;
        } else if (takes_glossy) {
            throughput = times(throughput, reflect_at_facet(material, vertex, onward, chance) * (total / glossy));
            if (!(inner(onward, facing) > 0) || !(largest(throughput) > 0)) return radiance;
        } else if (takes_mirror) {
            throughput = times(throughput, to_vector(optics.mirror) * (total / mirror));
        } else {
            onward = on_hemisphere(normal, chance);
            if (!(inner(onward, facing) > 0)) return radiance;
            throughput = times(throughput, scattered(material, onward) * (2 * inner(onward, normal) * total / lambert));
        }
        if (!through && !was_scattered && !takes_glossy) {
            onward = mirrored(vertex.direction, normal);
            if (!(inner(onward, facing) > 0)) onward = mirrored(vertex.direction, facing);
        }
        // Continue the path, or end it at its limits
        (was_scattered ? scatterings : through ? refractions : reflections) += 1;
        if (reflections > limits.reflection || refractions > limits.refraction || scatterings > limits.diffuse) {
            return radiance;
        }
        ray = {vertex.point, onward};
        source = {vertex.primitive, through ? !vertex.from_inside : vertex.from_inside};
        passed = {};
    }
}

}  // namespace tandem::oracle
