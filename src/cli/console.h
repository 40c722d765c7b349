// Log lines and progress on standard error, results on standard output.
#pragma once

#include "penumbra/error.h"

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace penumbra::cli {

struct ConsoleOptions {
    bool quiet = false, verbose = false;
    std::optional<bool> color = {};  ///< absent: on a terminal, unless NO_COLOR is set
};

/// Safe to use from several threads.
class Console {
  public:
    explicit Console(const ConsoleOptions& chosen = {});

    void error(const std::string& text);
    void internal_error(const std::string& text);
    void warning(const std::string& text);  ///< not with --quiet
    void detail(const std::string& text);   ///< only with --verbose
    void losses(const Losses& list);        ///< a warning each; similar ones together

    /// Writes lines to standard output at once. Throws Error (output) when that fails.
    void result(const std::string& made);

    bool quiet() const { return options_.quiet; }

    /// A function for Watch::progress that draws a bar, or an empty one where none is wanted.
    /// `work` names what is done; `units` of `unit` are the whole of it, for the rate.
    std::function<void(double)> progress(const std::string& work, double units = 0,
                                         const std::string& unit = "");
    /// Removes the bar.
    void clear_progress();

  private:
    struct Bar;
    ConsoleOptions options_;
    bool terminal_ = false, colored_ = false, bar_drawn_ = false;
    std::mutex mutex_;

    void line(const char* color, const char* kind, const std::string& text);
    void draw(Bar& bar, double done);
    void clear_bar();
};

}  // namespace penumbra::cli
