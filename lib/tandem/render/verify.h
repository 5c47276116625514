/// Verifies that an image agrees with its metadata, by rendering some of its tiles again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tandem/compile/prepare.h"
#include "tandem/images/image_codecs.h"
#include "tandem/render/backend.h"
#include "tandem/render/tile_grid.h"
#include "tandem/scene/scene.h"

namespace tandem {

struct VerifyOptions {
    std::size_t tiles = 16;  ///< how many to render; all if there are no more
    std::uint64_t seed = 0;  ///< which
};

struct Verdict {
    std::size_t tiles = 0;  ///< of the image
    std::size_t drawn = 0;  ///< of them
    std::size_t pixels = 0, drawn_pixels = 0;
    std::size_t differing_pixels = 0;     ///< in these tiles
    std::vector<FilmWindow> differing{};  ///< the tiles with such pixels
    bool has_film = false;                ///< every tile was rendered, so that the film has a hash
    bool film_matches = false;            ///< that hash is the one of the metadata
    [[nodiscard]] bool matches() const { return differing_pixels == 0 && (!has_film || film_matches); }
    /// A share of tiles, from 0 to 1: if more of them differed, 95 % of such random choices would have found one (the
    /// rule of three: 3 / drawn). 0 if every tile was rendered.
    [[nodiscard]] double largest_unseen_share() const;
};

/// Renders random tiles again from the metadata of an image, and compares them with the file: the bits of the floats of
/// PFM and EXR, and the 8-bit values of PNG and PPM. Planes beside the colour are not compared. `options.effects` and
/// the camera are those of the image. Throws InputError if the image has no metadata or was denoised, if the scene is
/// another, if the frame was of the tier fast, or if the backend does not guarantee the bits of the one that rendered
/// it.
[[nodiscard]] Verdict verify_image(Backend& backend, const Scene& scene, const PrepareOptions& options,
                                   const DecodedImage& image, const VerifyOptions& how);

}  // namespace tandem
