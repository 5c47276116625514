#include "render/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace tandem {

namespace {

std::string clock_text(double seconds) {
    const auto whole = static_cast<long long>(std::ceil(seconds));
    if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

std::string progress_line(std::size_t done, std::size_t rendered, std::size_t total, double seconds) {
    constexpr std::size_t cells = 30;
    const std::size_t filled = total > 0 ? done * cells / total : cells;
    std::string bar(filled, '=');
    if (filled < cells) bar += '>';
    bar.resize(cells, ' ');
    std::string line = fmt::format("[{}] {}/{}", bar, done, total);
    if (rendered > 0 && done < total) {
        const double per_frame = seconds / static_cast<double>(rendered);
        line += fmt::format(", {} left", clock_text(per_frame * static_cast<double>(total - done)));
    }
    return line;
}

ProgressBar::ProgressBar(std::size_t total, bool shown) : total_(total), shown_(shown) {}

void ProgressBar::clear() const {
    if (shown_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::draw() const {
    if (!shown_) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    std::fprintf(stderr, "\r\x1b[K%s", progress_line(done_, rendered_, total_, elapsed.count()).c_str());
}

void ProgressBar::advance(bool rendered) {
    ++done_;
    rendered_ += rendered ? 1 : 0;
}

bool stderr_is_terminal() { return ::isatty(STDERR_FILENO) == 1; }

}  // namespace tandem
