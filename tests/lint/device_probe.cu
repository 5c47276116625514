// Everything of the kernel side that computes, for ptx.py to look at: the exact functions and one pixel.
#include "cuda/render_thread.h"
#include "tandem/kernel/bsdf/lobes.h"
#include "tandem/kernel/bsdf/metallic_roughness.h"
#include "tandem/kernel/lights/environment_picture.h"
#include "tandem/kernel/lights/quad_light.h"
#include "tandem/kernel/lights/sphere_light.h"
#include "tandem/kernel/pixel.h"
#include "tandem/kernel/roulette.h"
#include "tandem/kernel/sampler/mis.h"
#include "tandem/kernel/sampler/warp.h"
#include "tandem/kernel/traversal/intersect.h"
#include "tandem/math/exact_math.h"

namespace tandem {

__global__ void exact_functions(const float* x, const float* y, float* out) {
    const unsigned i = threadIdx.x;
    out[0 * blockDim.x + i] = exact_sin(x[i]);
    out[1 * blockDim.x + i] = exact_cos(x[i]);
    out[2 * blockDim.x + i] = exact_exp(x[i]);
    out[3 * blockDim.x + i] = exact_log(x[i]);
    out[4 * blockDim.x + i] = exact_pow(x[i], y[i]);
}

template <class L>
TANDEM_HD void ask(const L& lobe, const Vec3d& wo, const Vec3d& wi, double* out) {
    const LobeSample<float> drawn = lobe.sample(wo, wi);
    const Vec3f colours = (lobe.f(wo, wi) + lobe.albedo(wo)) + drawn.weight;
    out[0] = widen((colours.x + colours.y) + colours.z);
    out[1] = (drawn.wi.x + drawn.wi.y) + drawn.wi.z;
    out[2] = lobe.pdf(wo, wi) + drawn.pdf;
}

__global__ void lobes(MetallicRoughness<float> material, float shininess, double eta, Vec3d wo, Vec3d wi, double* out) {
    const MetallicRoughnessLobes<float> made = lobes_of(material);
    ask(made.specular, wo, wi, out);
    ask(made.diffuse, wo, wi, out + 3);
    ask(PhongLobe<float>{material.base_colour, shininess}, wo, wi, out + 6);
    ask(Dielectric<float>{1.0F, eta}, wo, wi, out + 9);
    ask(Mirror<float>{material.base_colour}, wo, wi, out + 12);
}

template <class View>
TANDEM_HD void sample_and_weigh(const View& view, double u, double v, double* out) {
    const LightSample<float> sample = sample_light(view, u, v);
    out[0] = sample.direction.x + sample.direction.y + sample.direction.z;
    out[1] = sample.point.x + sample.point.y + sample.point.z;
    out[2] = sample.distance;
    out[3] = power_heuristic(sample.pdf, pdf_of(view, sample.direction));
}

__global__ void sphere_light(Vec3d point, Vec3d centre, double radius, double u, double v, double* out) {
    sample_and_weigh(view_sphere_light<float>(point, centre, radius), u, v, out);
}

__global__ void quad_light(Vec3d point, Vec3d v0, Vec3d v1, Vec3d v2, Vec3d v3, double u, double v, double* out) {
    sample_and_weigh(view_quad_light<float>(point, v0, v1, v2, v3), u, v, out);
}

__global__ void environment_picture(EnvironmentPictureView view, PhiloxBlock<std::uint32_t> random, double* out) {
    const auto drawn = sample_environment<float>(view, random);
    const auto seen = see_environment<float>(view, drawn.direction);
    out[0] = drawn.pdf + seen.pdf;
    out[1] = static_cast<double>(norm1(drawn.radiance) + norm1(seen.radiance));
}

__global__ void warps(int blades, double u, double v, double* out) {
    const Vec2<double> lens = sample_aperture<float>(blades, 0.0, u, v);
    const auto bounce = sample_cosine_hemisphere<float>(sample_sphere<float>(u, v).direction, v, u);
    const double probability = survival_probability(bounce.direction, 0.05);
    out[0] = lens.x;
    out[1] = lens.y;
    out[2] = balance_heuristic(bounce.pdf, probability);
    out[3] = survives<float>(probability, u) ? 1.0 : 0.0;
}

__global__ void one_pixel(SceneView scene, PixelJob job, double* out) {
    using Effects = EffectSet<all_effects.bits()>;
    const auto pixel = render_pixel<Effects, float>(LoopTracer{scene}, scene, job, blockIdx.x, threadIdx.x, true);
    out[0] = pixel.sum.x;
    out[1] = pixel.sum.y;
    out[2] = pixel.sum.z;
}

}  // namespace tandem
