/// What is wrong with a part of a file, and going on without that part.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "tandem/base/error.h"
#include "tandem/gltf/report.h"

namespace tandem::gltf {

/// A part of a file that cannot be taken as it stands. Code that can go on without that part catches the flaw and hands
/// it to a FlawLog. Where nobody can, it is the InputError that refuses the file.
class Flaw : public InputError {
  public:
    /// The message is "FILE: JSON_PATH: WHAT". `root`: the flaw behind this one, as "JSON_PATH: WHAT"; this one itself
    /// if it is empty.
    Flaw(const std::filesystem::path& file, std::string json_path, std::string what, std::string root = "");

    [[nodiscard]] const std::string& json_path() const { return json_path_; }
    [[nodiscard]] const std::string& what_is_wrong() const { return what_is_wrong_; }
    [[nodiscard]] const std::string& root() const { return root_; }

  private:
    std::string json_path_;
    std::string what_is_wrong_;
    std::string root_;
};

/// Writes the flaws of one file into its report.
class FlawLog {
  public:
    explicit FlawLog(ImportReport& report) : report_(report) {}

    /// The scene is without `feature`.
    void leave_out(std::string_view feature, const Flaw& flaw);

    /// The scene has a part of `feature` only.
    void shorten(std::string_view feature, const Flaw& flaw);

    /// The scene has something else in place of what the file says; `reason` says what.
    void replace(std::string_view feature, std::string_view json_path, std::string_view reason);

    /// The file says something that glTF forbids, and the scene has it as it stands.
    void tolerate(std::string_view feature, std::string_view json_path, std::string_view reason);

    /// For a scene without any geometry: refuses the file if a flaw may be why. Throws the first one.
    void refuse_lost_geometry() const;

  private:
    void add(Treatment treatment, std::string_view feature, const Flaw& flaw);

    ImportReport& report_;
    std::optional<Flaw> first_of_geometry_;
};

}  // namespace tandem::gltf
