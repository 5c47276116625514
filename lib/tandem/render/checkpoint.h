/// Files of unfinished renders (docs/long-renders.md).
#pragma once

#include <string>

#include "tandem/images/image_metadata.h"
#include "tandem/render/stats.h"
#include "tandem/render/tiled_film.h"

namespace tandem {

struct Checkpoint {
    ImageMetadata frame;  ///< describe(): what the tiles are of
    RenderCounters counters;
    TiledFilm film;
};

/// Writes the tiles that have samples, whole or not at all (write_file()): sums and planes in their memory's form,
/// behind a text with the frame, the samples of the tiles and the counters, and a SHA-256 of everything.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint);

/// Reads it back, bit for bit. Throws InputError that says what to do if the file cannot be read, is no checkpoint, is
/// damaged, or was written by a version with another form.
[[nodiscard]] Checkpoint read_checkpoint(const std::string& path);

}  // namespace tandem
