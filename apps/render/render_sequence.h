/// Frames of a scene, rendered by any backend and written as image files.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/arguments.h"
#include "tandem/effects/names.h"
#include "tandem/images/image_io.h"
#include "tandem/render/backend.h"
#include "tandem/scene/scene.h"

namespace tandem {

struct SequenceOptions {
    std::string output;  ///< a FramePattern
    FrameRange frames;
    RenderJob job;  ///< its frame is set for each frame
    /// The job's samples are nobody's wish: scenes whose rays are very much work get fewer (render/ray_cost.h).
    bool fewer_samples = false;
    bool shorter_paths = false;  ///< the same of the job's limits
    std::string camera;          ///< empty: the first of the scene
    ForcedEffects effects{};
    WriteOptions write;  ///< its display is the scene's, but for these two:
    std::optional<TransferFunction> transfer;
    std::optional<ExposureChoice> exposure;
    bool force = false;  ///< render frames again whose files exist
    int writers = 0;     ///< threads that hash, encode and write; 0: one per core
};

/// The time of a frame by phase, in seconds. Frames overlap, so the sums are more than the wall time.
struct FrameSeconds {
    double prepare = 0;  ///< scene to flat arrays, and their hash; for all instants of a frame with motion blur
    PhaseTimes backend;  ///< zero build and upload where the scene is that of the frame before
    double hash = 0;     ///< SHA-256 of the film
    double encode = 0;   ///< means, exposure, transfer function, compression
    double write = 0;
};

struct FrameRecord {
    ImageMetadata metadata;
    std::string file;
    bool skipped = false;  ///< the file was there already; the metadata are the file's
    FrameSeconds seconds;
    RenderCounters counters;
    std::size_t nan_values = 0;  ///< EncodedImage
    double bounds_per_ray = 0;   ///< where fewer samples were taken for it, or paths shortened, else 0
    bool has_short_paths = false;
    bool has_opaque_masks = false;  ///< alpha masks were left out for the same reason
    // of RenderStats
    std::string variant{};
    EffectMask effects{}, carried{};
    int registers = 0;
    double occupancy = 0;
    std::string warning{};
};

/// Calls `on_frame` for each frame that is done, in order, on the calling thread, as soon as its file is there.
///
/// Two frames are with the backend at a time, or two instants of a frame with motion blur; hashing, encoding and
/// writing run in other threads meanwhile, as many at a time as there are writers (fewer where films are large). A
/// frame is not rendered again if its file can be read whole, is of the format asked for, and its metadata have the
/// same scene hash, frame, size, samples, seed, limits, tier, version, transfer function and exposure. The backend may
/// differ: films are equal. Once `interrupted` is set no frame is started; those in flight are finished and written.
///
/// An automatic exposure is that of the first frame, so that nothing flickers: auto_exposure() of its foreground. If
/// its file exists and says that its exposure was automatic, it is taken from the file.
///
/// With `fewer_samples` or `shorter_paths` the first frame decides for all.
///
/// Returns the number of frames done. Throws InputError for options, scenes and paths that cannot be, if possible
/// before the first frame; errors of backends and writers come out as they are. Then files that were written stay,
/// whole.
std::size_t render_sequence(const Scene& scene, Backend& backend, const SequenceOptions& options,
                            const std::atomic<bool>& interrupted,
                            const std::function<void(const FrameRecord&)>& on_frame);

/// Throws as render_sequence() does for an output that cannot be, without a scene or a backend.
void check_output(const SequenceOptions& options);

}  // namespace tandem
