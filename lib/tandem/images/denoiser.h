/// Denoising by Intel Open Image Denoise, which is opened at run time if it is installed (docs/denoising.md). A
/// denoised image has an unknown bias and no guaranteed bits: it is not a film, and its metadata say that.
#pragma once

#include <memory>
#include <string>

#include "tandem/film/film.h"
#include "tandem/images/image.h"

namespace tandem {

/// The planes that help the denoiser to tell detail from noise.
inline constexpr PlaneMask denoiser_planes = FilmPlane::albedo | FilmPlane::normal;

/// Calls may come from several threads; they wait for one another.
class Denoiser {
  public:
    /// `library`: a file; if empty, libOpenImageDenoise.so.2, .1 and then without a number, where the system's loader
    /// looks. `threads`: 0 means as many as the library chooses. Throws EnvironmentError, which says what to install
    /// and where the library was looked for, or has the library's own message.
    explicit Denoiser(const std::string& library = {}, int threads = 0);
    ~Denoiser();
    Denoiser(const Denoiser&) = delete;
    Denoiser& operator=(const Denoiser&) = delete;

    /// "Open Image Denoise 2.5.1".
    [[nodiscard]] const std::string& name() const;

    /// The means of the film, denoised as linear radiance (HDR). The film must have the denoiser_planes. Throws
    /// EnvironmentError with the library's own message if it fails.
    [[nodiscard]] FloatImage denoise(const Film& film) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tandem
