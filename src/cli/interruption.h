// Ctrl-C -> a request to stop.
#pragma once

#include <filesystem>
#include <stop_token>
#include <thread>

namespace penumbra::cli {

/// Names the folder to remove when the process is ended before its work heeds the request.
void set_leftover(const std::filesystem::path& folder);
/// Removes it now.
void remove_leftover();

/// Turns SIGINT, SIGTERM and SIGHUP into a stop request. Work that does not heed the request in
/// time is ended together with the process: exit status 130 within a second either way.
class Interruption {
  public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    std::stop_token token() const { return source_.get_token(); }

  private:
    std::stop_source source_;
    std::jthread watcher_;
};

}  // namespace penumbra::cli
