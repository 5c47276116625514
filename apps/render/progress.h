/// A progress bar on standard error, on a terminal only.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace tandem {

/// "[=====>    ] 12/120, 1:05 left". Of the `done` frames, `rendered` took `seconds`; the others were kept. Without a
/// rendered frame the time left is unknown.
[[nodiscard]] std::string progress_line(std::size_t done, std::size_t rendered, std::size_t total, double seconds);

class ProgressBar {
  public:
    ProgressBar(std::size_t total, bool shown);
    ~ProgressBar() { clear(); }
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Clears the bar from the terminal, so that other lines can be printed.
    void clear() const;
    void draw() const;
    /// Counts a finished frame. Does not draw.
    void advance(bool rendered);

  private:
    std::size_t total_;
    bool shown_;
    std::size_t done_ = 0;
    std::size_t rendered_ = 0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Whether standard error is a terminal.
[[nodiscard]] bool stderr_is_terminal();

}  // namespace tandem
