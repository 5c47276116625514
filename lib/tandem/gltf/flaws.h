/// Flaws: errors in a part of a file, from which the import can recover.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "tandem/base/error.h"
#include "tandem/gltf/report.h"

namespace tandem::gltf {

/// An error in a part of a file. Code that can continue without that part catches the flaw and passes it to a FlawLog.
/// A flaw that is not caught refuses the file, as an InputError.
class Flaw : public InputError {
  public:
    /// The message is "FILE: JSON_PATH: WHAT". `root`: the flaw that caused this one, as "JSON_PATH: WHAT"; empty if
    /// this is the first.
    Flaw(const std::filesystem::path& file, std::string json_path, std::string what, std::string root = "");

    [[nodiscard]] const std::string& json_path() const { return json_path_; }
    [[nodiscard]] const std::string& what_is_wrong() const { return what_is_wrong_; }
    [[nodiscard]] const std::string& root() const { return root_; }

  private:
    std::string json_path_;
    std::string what_is_wrong_;
    std::string root_;
};

/// Adds the flaws of one file to its report.
class FlawLog {
  public:
    explicit FlawLog(ImportReport& report) : report_(report) {}

    /// The scene lacks `feature`.
    void leave_out(std::string_view feature, const Flaw& flaw);

    /// The scene has only a part of `feature`.
    void shorten(std::string_view feature, const Flaw& flaw);

    /// The scene has something else instead; `reason` says what.
    void replace(std::string_view feature, std::string_view json_path, std::string_view reason);

    /// The file violates glTF, but the scene has the feature as it is in the file.
    void tolerate(std::string_view feature, std::string_view json_path, std::string_view reason);

    /// For a scene without geometry: refuses the file if a flaw may be the reason, by throwing the first such flaw.
    void refuse_lost_geometry() const;

  private:
    void add(Treatment treatment, std::string_view feature, const Flaw& flaw);

    ImportReport& report_;
    std::optional<Flaw> first_of_geometry_;
};

}  // namespace tandem::gltf
