#include "cli/console.h"

#include "base/loss_tally.h"
#include "base/text/text.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

namespace penumbra::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* red = "\033[1;31m";
constexpr const char* yellow = "\033[1;33m";
constexpr const char* faint = "\033[2m";
constexpr const char* normal = "\033[0m";
constexpr const char* erase_line = "\r\033[K";

bool environment_wants_color() {
    const char* const no_color = std::getenv("NO_COLOR");
    const char* const term = std::getenv("TERM");
    return (no_color == nullptr || *no_color == 0) && term != nullptr &&
           std::string_view(term) != "dumb";
}

int columns() {
    winsize size{};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string duration(double seconds) {
    const auto whole = long(std::ceil(seconds));
    if (whole >= 3600)
        return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string rate(double per_second, const std::string& unit) {
    if (per_second >= 1e6) return fmt::format("{:.1f} M{}/s", per_second / 1e6, unit);
    if (per_second >= 1e3) return fmt::format("{:.0f} k{}/s", per_second / 1e3, unit);
    return fmt::format("{:.1f} {}/s", per_second, unit);
}

}  // namespace

struct Console::Bar {
    std::string work, unit;
    double units = 0;
    Clock::time_point start = Clock::now(), drawn = {};
};

Console::Console(const ConsoleOptions& chosen)
    : options_(chosen), terminal_(isatty(STDERR_FILENO) == 1),
      colored_(chosen.color.value_or(terminal_ && environment_wants_color())) {}

void Console::error(const std::string& text) { line(red, "error: ", text); }

void Console::internal_error(const std::string& text) { line(red, "internal error: ", text); }

void Console::warning(const std::string& text) {
    if (!options_.quiet) line(yellow, "warning: ", text);
}

void Console::detail(const std::string& text) {
    if (options_.verbose && !options_.quiet) line(faint, "", text);
}

void Console::losses(const Losses& list) {
    for (const Loss& loss : options_.verbose ? merged(list) : merged_places(list))
        warning(loss.place + ": " + loss.what);
}

void Console::result(const std::string& made) {
    const std::string text = plain_lines(made);
    const std::lock_guard lock(mutex_);
    clear_bar();
    errno = 0;
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (!written || std::fflush(stdout) != 0)
        throw Error(Failure::output, "standard output", std::strerror(errno));
}

void Console::line(const char* color, const char* kind, const std::string& text) {
    const std::lock_guard lock(mutex_);
    clear_bar();
    const std::string whole =
        colored_ ? fmt::format("{}penumbra: {}{}{}\n", color, kind, normal, one_line(text))
                 : fmt::format("penumbra: {}{}\n", kind, one_line(text));
    std::fwrite(whole.data(), 1, whole.size(), stderr);
}

std::function<void(double)> Console::progress(const std::string& work, double units,
                                              const std::string& unit) {
    if (!terminal_ || options_.quiet) return {};
    auto bar = std::make_shared<Bar>();
    bar->work = one_line(work);
    bar->unit = unit;
    bar->units = units;
    return [this, bar](double done) { draw(*bar, done); };
}

void Console::draw(Bar& bar, double done) {
    constexpr auto pause = std::chrono::milliseconds(100);
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    if (now - bar.drawn < pause) return;
    bar.drawn = now;

    done = std::clamp(done, 0.0, 1.0);
    const double elapsed = std::chrono::duration<double>(now - bar.start).count();
    std::string right = fmt::format(" {:3.0f} %", done * 100);
    if (bar.units > 0 && elapsed > 0) right += "  " + rate(done * bar.units / elapsed, bar.unit);
    if (done > 0.01) right += "  " + duration(elapsed * (1 - done) / done) + " left";

    const int free = columns() - int(bar.work.size() + right.size()) - 5;
    const int width = std::clamp(free, 0, 40);
    const int filled = int(std::lround(done * width));
    const std::string text = fmt::format("{}{} [{:#<{}}{:.<{}}]{}", erase_line, bar.work, "",
                                         filled, "", width - filled, right);
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
    bar_drawn_ = true;
}

void Console::clear_progress() {
    const std::lock_guard lock(mutex_);
    clear_bar();
}

void Console::clear_bar() {
    if (bar_drawn_) std::fputs(erase_line, stderr);
    bar_drawn_ = false;
}

}  // namespace penumbra::cli
