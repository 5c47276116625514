// The paper's method as a student of a course on ray tracing would write it, for the host and for CUDA. Included by
// naive_cpu.cpp, which is compiled once without and once with optimisation, and by naive_kernel.cu; each has its own
// namespace NAIVE_NAMESPACE, so that the linker cannot mix them.
//
// It is plain on purpose: floats, powf, the textbook quadratic, the scene in the code. It uses nothing of Tandem and
// no template of the standard library, whose copies the linker would share between -O0 and -O3.
#pragma once

#include <math.h>

#include "naive_renderer.h"

#if defined(__CUDACC__)
#define NAIVE_HD __host__ __device__
#else
#define NAIVE_HD
#endif

namespace NAIVE_NAMESPACE {

using tandem::bench::NaiveFrame;

class Vec3 {
  public:
    float x, y, z;
    NAIVE_HD Vec3() : x(0), y(0), z(0) {}
    NAIVE_HD Vec3(float x_, float y_, float z_) : x(x_), y(y_), z(z_) {}
};

NAIVE_HD inline Vec3 operator+(const Vec3& a, const Vec3& b) { return Vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
NAIVE_HD inline Vec3 operator-(const Vec3& a, const Vec3& b) { return Vec3(a.x - b.x, a.y - b.y, a.z - b.z); }
NAIVE_HD inline Vec3 operator*(const Vec3& a, const Vec3& b) { return Vec3(a.x * b.x, a.y * b.y, a.z * b.z); }
NAIVE_HD inline Vec3 operator*(float s, const Vec3& a) { return Vec3(s * a.x, s * a.y, s * a.z); }
NAIVE_HD inline float dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
NAIVE_HD inline Vec3 unit(const Vec3& a) { return (1.0f / sqrtf(dot(a, a))) * a; }

class Ray {
  public:
    Vec3 origin, direction;
    NAIVE_HD Ray(const Vec3& o, const Vec3& d) : origin(o), direction(d) {}
    NAIVE_HD Vec3 at(float t) const { return origin + t * direction; }
};

class Camera {
  public:
    Vec3 origin, lower_left, horizontal, vertical;
    NAIVE_HD explicit Camera(float aspect) {
        const float half_height = 1.0f / 1.5f;  // tangent of half the vertical angle
        const float half_width = aspect * half_height;
        origin = Vec3(0, 0, 0);
        lower_left = Vec3(-half_width, -half_height, -1.0f);
        horizontal = Vec3(2 * half_width, 0, 0);
        vertical = Vec3(0, 2 * half_height, 0);
    }
    NAIVE_HD Ray get_ray(float u, float v) const {
        return Ray(origin, lower_left + u * horizontal + v * vertical - origin);
    }
};

// Marsaglia's XORWOW (Journal of Statistical Software 8(14), 2003), seeded by a linear congruential generator and run
// in for a while: one state per pixel, seeded with 1984 + pixel as in the paper.
struct RandomState {
    unsigned int x, y, z, w, v, d;
};

NAIVE_HD inline unsigned int random_bits(RandomState& s) {
    const unsigned int t = s.x ^ (s.x >> 2);
    s.x = s.y;
    s.y = s.z;
    s.z = s.w;
    s.w = s.v;
    s.v = (s.v ^ (s.v << 4)) ^ (t ^ (t << 1));
    s.d += 362437u;
    return s.d + s.v;
}

NAIVE_HD inline RandomState random_init(unsigned int seed) {
    unsigned int words[6];
    unsigned int h = seed;
    for (int i = 0; i < 6; i++) {
        h = h * 1664525u + 1013904223u;
        words[i] = (h ^ (h >> 15)) | 1u;
        h = words[i] * 2654435769u;
    }
    RandomState s = {words[0], words[1], words[2], words[3], words[4], words[5]};
    for (int i = 0; i < 16; i++) random_bits(s);
    return s;
}

NAIVE_HD inline float random_uniform(RandomState& s) { return (float)(random_bits(s) >> 8) * (1.0f / 16777216.0f); }

NAIVE_HD inline unsigned int pixel_seed(int pixel, unsigned int sequence) {
    return 1984u + (unsigned int)pixel + sequence * 100000007u;
}

// t of the first hit in front of the origin, or a negative number.
NAIVE_HD inline float hit_sphere(const Vec3& centre, float radius, const Ray& r) {
    const Vec3 oc = r.origin - centre;
    const float a = dot(r.direction, r.direction);
    const float b = 2.0f * dot(oc, r.direction);
    const float c = dot(oc, oc) - radius * radius;
    const float discriminant = b * b - 4 * a * c;
    if (discriminant < 0) return -1.0f;
    const float root = sqrtf(discriminant);
    const float t = (-b - root) / (2.0f * a);
    if (t > 0) return t;
    return (-b + root) / (2.0f * a);
}

NAIVE_HD inline bool slab(float low, float high, float origin, float direction, float& t_min, float& t_max) {
    float t0 = (low - origin) / direction;
    float t1 = (high - origin) / direction;
    if (t0 > t1) {
        const float swap = t0;
        t0 = t1;
        t1 = swap;
    }
    if (t0 > t_min) t_min = t0;
    if (t1 < t_max) t_max = t1;
    return t_min <= t_max;
}

NAIVE_HD inline float hit_cube(const Vec3& centre, float side, const Ray& r) {
    const float h = side / 2;
    float t_min = -1e30f;
    float t_max = 1e30f;
    if (!slab(centre.x - h, centre.x + h, r.origin.x, r.direction.x, t_min, t_max)) return -1.0f;
    if (!slab(centre.y - h, centre.y + h, r.origin.y, r.direction.y, t_min, t_max)) return -1.0f;
    if (!slab(centre.z - h, centre.z + h, r.origin.z, r.direction.z, t_min, t_max)) return -1.0f;
    return t_min > 0 ? t_min : t_max;
}

// The normal of the face nearest to the point.
NAIVE_HD inline Vec3 cube_normal(const Vec3& centre, const Vec3& p) {
    const Vec3 d = p - centre;
    const float ax = fabsf(d.x), ay = fabsf(d.y), az = fabsf(d.z);
    if (ax > ay && ax > az) return Vec3(d.x > 0 ? 1.0f : -1.0f, 0, 0);
    if (ay > az) return Vec3(0, d.y > 0 ? 1.0f : -1.0f, 0);
    return Vec3(0, 0, d.z > 0 ? 1.0f : -1.0f);
}

NAIVE_HD inline Vec3 phong(const Vec3& p, const Vec3& normal, const Vec3& diffuse, const Vec3& light,
                           const Vec3& direction) {
    Vec3 colour = 0.1f * diffuse;
    const Vec3 l = unit(light - p);
    const float diffuse_weight = dot(l, normal);
    if (diffuse_weight > 0) colour = colour + diffuse_weight * diffuse;
    const Vec3 reflected = 2.0f * diffuse_weight * normal - l;
    const Vec3 viewer = unit(-1.0f * direction);
    const float specular_weight = dot(reflected, viewer);
    if (specular_weight > 0) colour = colour + powf(specular_weight, 32.0f) * Vec3(1, 1, 1);
    return colour;
}

const float sphere_radius = 0.5f;
const float cube_side = 0.6f;

NAIVE_HD inline Vec3 sphere_centre(int i) { return Vec3((float)(i - 1) * 1.2f, 0, -3); }

NAIVE_HD inline Vec3 sphere_colour(int i) {
    return Vec3(i == 0 ? 0.8f : 0.2f, i == 1 ? 0.8f : 0.2f, i == 2 ? 0.8f : 0.2f);
}

// The nearest hit. 0 to 2: a sphere; 3: the cube; -1: none.
NAIVE_HD inline int nearest(const NaiveFrame& frame, const Ray& r, float& nearest_t) {
    int object = -1;
    nearest_t = 1e30f;
    for (int i = 0; i < 3; i++) {
        const float t = hit_sphere(sphere_centre(i), sphere_radius, r);
        if (t > 0 && t < nearest_t) {
            nearest_t = t;
            object = i;
        }
    }
    const float t = hit_cube(Vec3(frame.cube[0], frame.cube[1], frame.cube[2]), cube_side, r);
    if (t > 0 && t < nearest_t) {
        nearest_t = t;
        object = 3;
    }
    return object;
}

NAIVE_HD inline Vec3 ray_colour(const NaiveFrame& frame, const Ray& r) {
    float t;
    const int object = nearest(frame, r, t);
    if (object < 0) {
        const float m = 0.5f * (unit(r.direction).y + 1.0f);
        return (1.0f - m) * Vec3(1, 1, 1) + m * Vec3(0.5f, 0.7f, 1.0f);
    }
    const Vec3 p = r.at(t);
    const Vec3 light(frame.light[0], frame.light[1], frame.light[2]);
    if (object < 3) return phong(p, unit(p - sphere_centre(object)), sphere_colour(object), light, r.direction);
    const Vec3 cube(frame.cube[0], frame.cube[1], frame.cube[2]);
    return phong(p, cube_normal(cube, p), Vec3(0.8f, 0.8f, 0.2f), light, r.direction);
}

// Mean over the samples of a pixel; row 0 is at the top.
NAIVE_HD inline Vec3 pixel_colour(const NaiveFrame& frame, int x, int y, int width, int height, int samples,
                                  RandomState& random) {
    const Camera camera((float)width / (float)height);
    Vec3 sum;
    for (int s = 0; s < samples; s++) {
        const float u = ((float)x + random_uniform(random)) / (float)width;
        const float v = ((float)(height - 1 - y) + random_uniform(random)) / (float)height;
        sum = sum + ray_colour(frame, camera.get_ray(u, v));
    }
    return (1.0f / (float)samples) * sum;
}

}  // namespace NAIVE_NAMESPACE
