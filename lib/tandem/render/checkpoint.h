/// Files of unfinished renders (docs/long-renders.md).
#pragma once

#include <optional>
#include <string>

#include "tandem/images/image_metadata.h"
#include "tandem/render/round_state.h"
#include "tandem/render/stats.h"

namespace tandem {

struct Checkpoint {
    ImageMetadata frame;  ///< describe() of the frame that the tiles belong to
    RenderCounters counters;
    TiledFilm film;
    std::optional<Round> round{};  ///< in progress, of a render to a target
};

/// Writes the tiles that have samples, as a whole file or not at all (write_file()): the SHA-256 of what follows it, a
/// text with the frame, the samples of the tiles, the round and the counters, and the sums and planes as in memory.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint);

/// Reads it back, bit for bit. Throws InputError that says what to do if the file cannot be read, is no checkpoint, is
/// damaged, or was written by a version with another format.
[[nodiscard]] Checkpoint read_checkpoint(const std::string& path);

}  // namespace tandem
