/// Frames of a scene, rendered by any backend and written as image files.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/arguments.h"
#include "tandem/effects/names.h"
#include "tandem/images/denoiser.h"
#include "tandem/images/image_io.h"
#include "tandem/render/adaptive_frame.h"
#include "tandem/render/backend.h"
#include "tandem/render/checkpointed_frame.h"
#include "tandem/scene/scene.h"

namespace tandem {

struct SequenceOptions {
    std::string output;  ///< a FramePattern
    FrameRange frames;
    RenderJob job;  ///< its frame is set for each frame
    /// Take fewer samples than the job's in scenes whose rays are expensive, since no user set them
    /// (render/ray_cost.h).
    bool fewer_samples = false;
    bool shorter_paths = false;  ///< the same for the job's limits
    std::string camera;          ///< empty: the first of the scene
    ForcedEffects effects{};
    WriteOptions write;  ///< its display is that of the scene, except for these two:
    std::optional<TransferFunction> transfer;
    std::optional<ExposureChoice> exposure;
    bool force = false;                           ///< render frames even if their files exist
    std::optional<CheckpointOptions> checkpoint;  ///< for one frame
    std::optional<RenderTarget> target;           ///< of every frame; the job has the most samples
    std::string scene_source;                     ///< for the metadata: to_json() of where the scene is from
    std::shared_ptr<const Denoiser> denoiser{};   ///< null: images are as rendered
    int writers = 0;                              ///< threads that hash, encode and write; 0: one per core
};

/// The time of a frame by phase, in seconds. Frames overlap, so the sums are more than the wall time.
struct FrameSeconds {
    double prepare = 0;  ///< scene to flat arrays, and their hash; for all instants of a frame with motion blur
    PhaseTimes backend;  ///< build and upload are zero if the scene is that of the frame before
    double hash = 0;     ///< SHA-256 of the film
    double denoise = 0;  ///< waits for other frames included
    double encode = 0;   ///< means, exposure, transfer function, compression
    double write = 0;
};

struct FrameRecord {
    ImageMetadata metadata;
    std::string file;
    bool skipped = false;  ///< the file existed already, and the metadata are its
    FrameSeconds seconds;
    RenderCounters counters;
    std::size_t nan_values = 0;  ///< EncodedImage
    double bounds_per_ray = 0;   ///< if samples or path lengths were reduced because of it, else 0
    bool has_short_paths = false;
    double mean_samples = 0;        ///< per pixel, of a frame with a target
    bool has_opaque_masks = false;  ///< alpha masks are ignored for the same reason
    // of RenderStats
    std::string variant{};
    EffectMask effects{}, carried{};
    int registers = 0;
    double occupancy = 0;
    std::string warning{};
};

/// Calls `on_frame` for each finished frame, in order, on the calling thread, as soon as its file is written.
///
/// The backend renders two frames at a time, or two instants of a frame with motion blur. Meanwhile other threads hash,
/// encode and write, as many as there are writers (fewer if films are large). A frame is not rendered again if its file
/// can be read whole, has the requested format, and its metadata have the same scene hash, frame, size, samples, seed,
/// limits, tier, version, transfer function and exposure. The backend may differ: films are equal. Once `interrupted`
/// is set no frame is started; those in flight are finished and written.
///
/// An automatic exposure is that of the first frame, so that nothing flickers: auto_exposure() of its foreground. If
/// the file of that frame exists and its exposure was automatic, the exposure is taken from the file.
///
/// With `fewer_samples` or `shorter_paths` the first frame decides for all.
///
/// With a `denoiser` the file has the denoised image, and its metadata say so; their film_sha256 is that of the film
/// before. The planes in the file are those of the job, although the denoiser_planes are rendered too.
///
/// With a `target` frames are rendered by render_to_target(). A frame that a signal stopped short of it is written, but
/// not taken as finished by the next run. With a `checkpoint` the frame is rendered by render_with_checkpoints() or
/// render_to_target_with_checkpoints(); the file is removed when the image is written. If it is interrupted, the frame
/// is not finished.
///
/// Returns the number of finished frames. Throws InputError for invalid options, scenes and paths, if possible before
/// the first frame; the first error of a backend or a writer is passed on, once the frames that other writers hold are
/// written and reported. It names the file if it is one of a file. Files that were written stay, whole.
std::size_t render_sequence(const Scene& scene, Backend& backend, const SequenceOptions& options,
                            const std::atomic<bool>& interrupted,
                            const std::function<void(const FrameRecord&)>& on_frame);

/// How the frames are shown in .png and .ppm, unless the first one decides.
[[nodiscard]] Display display_of(const SequenceOptions& options, const Scene& scene);

/// Throws as render_sequence() does for an invalid output, but needs neither a scene nor a backend.
void check_output(const SequenceOptions& options);

}  // namespace tandem
