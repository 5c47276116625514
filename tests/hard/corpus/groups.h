/// The groups of the corpus, a file each. To add a group: a function here, a file, a line in corpus().
#pragma once

#include "hard/corpus/hard_case.h"

namespace tandem::hard {

[[nodiscard]] std::vector<HardCase> sphere_cases();          // A
[[nodiscard]] std::vector<HardCase> box_cases();             // B
[[nodiscard]] std::vector<HardCase> face_cases();            // C
[[nodiscard]] std::vector<HardCase> structure_cases();       // D
[[nodiscard]] std::vector<HardCase> leaving_cases();         // E
[[nodiscard]] std::vector<HardCase> dielectric_cases();      // F
[[nodiscard]] std::vector<HardCase> shading_cases();         // G
[[nodiscard]] std::vector<HardCase> camera_cases();          // H
[[nodiscard]] std::vector<HardCase> film_cases();            // I
[[nodiscard]] std::vector<HardCase> transform_cases();       // J
[[nodiscard]] std::vector<HardCase> input_cases();           // K
[[nodiscard]] std::vector<HardCase> parity_cases();          // L
[[nodiscard]] std::vector<HardCase> light_cases();           // M
[[nodiscard]] std::vector<HardCase> light_surface_cases();   // M, area lights
[[nodiscard]] std::vector<HardCase> light_obstacle_cases();  // M, occluders

}  // namespace tandem::hard
