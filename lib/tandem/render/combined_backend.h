/// Several backends as one: the GPUs of a machine, or any others with equal bits.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tandem/render/backend.h"

namespace tandem {

struct CombinedMember {
    std::string name;  ///< for reports and errors: "GPU 1"
    std::unique_ptr<Backend> backend;
};

struct CombinedOptions {
    /// The least size of a part of a frame, or of rays, unless the whole is smaller.
    std::size_t least_pixels = std::size_t{1} << 16;
    std::size_t least_rays = std::size_t{1} << 18;
    double least_seconds = 1e-4;  ///< the least time that a part should take
    /// As BackendOptions::report.
    std::function<void(const std::string& sentence)> report{};
};

/// A backend that divides its work among the members. Each of them loads every scene. The rows of a window are cut into
/// bands, and a member that has finished a band takes another (division.h); rays are divided into parts in the same
/// way. A pixel and a ray are computed by one member, from the same numbers as without the others, so films and hits
/// have the bits that any of the members gives. Small windows are not cut; several of them are rendered at once
/// (frames_in_flight()).
///
/// A member that throws is left out from then on, and other members redo its unfinished parts. `options.report`, the
/// warning of the next frame, and capabilities() report this. Only an InputError, which says that the scene or the job
/// is wrong, is passed on. If no member is left, the error names all of them and their failures: an
/// EnvironmentError, unless one of the failures was a bug.
///
/// Each member is used from one thread alone, apart from make_film(). Of the frame's times, `compile` is the longest of
/// a member, `render` is the rest of the wall-clock time from the first band to the last, and downloads are part of it.
/// load_times() and trace() give the longest of any member. Throws InputError if there is no member.
[[nodiscard]] std::unique_ptr<Backend> make_combined_backend(std::vector<CombinedMember> members,
                                                             const CombinedOptions& options = {});

}  // namespace tandem
