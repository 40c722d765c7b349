// Ctrl-C -> a request to stop.
#pragma once

#include <filesystem>
#include <stop_token>
#include <thread>

namespace penumbra::cli {

/// The folder to remove when the process is ended before its work heeds the request; "": none.
void set_leftover(const std::filesystem::path& folder);

/// Call before the message that ends the program: an impatient interruption may be writing its own,
/// and then this waits for the end of the process.
void take_last_word();

/// Turns SIGINT, SIGTERM and SIGHUP into a stop request. Work that does not heed the request in
/// time is ended together with the process: exit status 130 within a second either way.
class Interruption {
  public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    std::stop_token token() const { return source.get_token(); }

  private:
    std::stop_source source;
    std::jthread watcher;
};

}  // namespace penumbra::cli
