/// Between the job of a frame and the metadata of its image.
#pragma once

#include <string>

#include "tandem/images/image_metadata.h"
#include "tandem/render/render_job.h"

namespace tandem {

/// Everything that determines the film of a frame, as metadata: the hash of its scene (FrameHash), the job, the backend
/// and Tandem's version. The film's hash and the display stay empty.
[[nodiscard]] ImageMetadata describe(const RenderJob& job, std::string scene_hash, std::string backend);

/// The job that `metadata` describe, without planes. Throws InputError for values that describe none.
[[nodiscard]] RenderJob job_of(const ImageMetadata& metadata);

/// The differences in describe(), or in the target, except for the backend: "seed is 1 there, but 2 here; ...". Empty
/// if there are none: then the films have equal bits.
[[nodiscard]] std::string difference_of_films(const ImageMetadata& there, const ImageMetadata& here);

}  // namespace tandem
