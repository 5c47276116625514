/// The import report: how each feature of a file is treated, so that nothing is dropped silently.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace tandem {

/// rendered: as specified. approximated: in another way, which the reason describes. ignored: not at all.
enum class Treatment { rendered, approximated, ignored };

[[nodiscard]] std::string to_string(Treatment treatment);

/// One extension or feature of a file.
struct ImportNote {
    Treatment treatment = Treatment::rendered;
    std::string feature;    ///< e.g. "EXT_implicit_geometry sphere", "light range"
    std::string json_path;  ///< of its first use, e.g. "meshes[2].primitives[0]"
    std::size_t uses = 1;
    std::string reason;  ///< how Tandem treats it, and why
};

class ImportReport {
  public:
    /// Adds a use. Uses of the same feature with the same treatment and reason become one note with the path of the
    /// first.
    void add(Treatment treatment, std::string_view feature, std::string_view json_path, std::string_view reason);

    /// Adds all notes of another report.
    void add(const ImportReport& other);

    [[nodiscard]] const std::vector<ImportNote>& notes() const { return notes_; }

  private:
    void add(ImportNote note);

    std::vector<ImportNote> notes_;
    std::map<std::tuple<Treatment, std::string, std::string>, std::size_t> index_;  ///< by treatment, feature, reason
};

/// One line: "ignored: light range at extensions.KHR_lights_punctual.lights[0].range (2 uses): ...".
[[nodiscard]] std::string to_string(const ImportNote& note);

}  // namespace tandem
