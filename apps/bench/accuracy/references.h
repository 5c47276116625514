/// What the images of the accuracy report are compared with.
#pragma once

#include <string>

#include "accuracy/accuracy_scenes.h"
#include "common/arguments.h"
#include "tandem/accuracy/reference.h"
#include "tandem/kernel/sampler/pixel_filter.h"
#include "tandem/render/backend.h"

namespace tandem::bench {

struct ReferenceOptions {
    FilmSize size;
    int samples = 1024;      ///< per pixel, of each of two
    std::uint64_t seed = 0;  ///< of the report; those of the references follow from it and differ from all others
    std::string folder;      ///< where references are kept; empty: nowhere
    bool rebuild = false;    ///< renders again what the folder has
    PixelFilter filter = PixelFilter::box;
};

struct DescribedReference {
    Reference reference;
    std::string description;  ///< a sentence: what it is, and where it is from
};

/// The closed form of a scene, or two images in the tier precise without limits of paths, by the sampler sobol with two
/// seeds. With a folder they are read from there, or rendered and written there: SCENE-WIDTHxHEIGHT-a.pfm and -b.pfm,
/// with the filter's name before the letter unless it is box, each with its metadata beside it. Throws InputError if a
/// file is of another scene, size, seed, sampler or number of samples, and says how to render it again;
/// EnvironmentError if the folder cannot be written.
[[nodiscard]] DescribedReference make_reference(const AccuracyScene& scene, Backend& backend,
                                                const ReferenceOptions& options);

/// The path of one of the two images of a scene, 'a' or 'b'.
[[nodiscard]] std::string reference_path(const AccuracyScene& scene, const ReferenceOptions& options, char which);

}  // namespace tandem::bench
