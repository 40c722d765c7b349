// Runs another program and waits for it, without a shell.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

namespace penumbra {

struct Command {
    std::vector<std::string> argv = {};  ///< the program's path first
    std::filesystem::path folder = {};   ///< where it runs; empty: here
    /// Variables that differ from ours; with an empty value: that it does not get.
    std::map<std::string, std::string> environment = {};
    std::chrono::milliseconds timeout{60'000};
    std::size_t memory = 0;           ///< bytes that it may take, stacks apart; 0: any
    std::function<void()> poll = {};  ///< called about 30 times a second while it runs
    std::stop_token stop = {};
};

struct Finished {
    enum class How { exited, signalled, timed_out, stopped };
    How how = How::exited;
    int code = 0;  ///< exit status, or the signal's number
    std::string output =
        {};              ///< stdout and stderr as they came; the middle of very long ones is cut
    double seconds = 0;  ///< wall time
    double cpu_seconds = 0;      ///< user + system, of the program and the children it waited for
    bool out_of_memory = false;  ///< it failed, and Command::memory is most likely why
};

/// Runs `command` with its input closed. It becomes the leader of a process group that does not
/// outlive it: on time-out and on stop the group gets SIGTERM and, 300 ms later, SIGKILL.
/// Should this process, or the thread that calls, end meanwhile, the program is killed, and what it
/// has started ends when each has used as much time as all processors have until the time-out.
/// Throws std::system_error when it cannot be started.
Finished run(const Command& command);

/// Where `name` is as a program: itself when it has a slash, else found in PATH; empty when there
/// is no such executable file.
std::filesystem::path find_program(const std::string& name);

}  // namespace penumbra
