#include "process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <system_error>

extern char** environ;

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds poll_interval{33}, grace{300};
constexpr std::size_t kept_half = 1U << 20;  // bytes of output kept from either end

void check(int error, const char* what) {
    if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

// What posix_spawn() needs, released at the end.
struct SpawnPlan {
    posix_spawn_file_actions_t actions{};
    posix_spawnattr_t attributes{};
    SpawnPlan() {
        check(posix_spawn_file_actions_init(&actions), "posix_spawn");
        check(posix_spawnattr_init(&attributes), "posix_spawn");
    }
    ~SpawnPlan() {
        posix_spawn_file_actions_destroy(&actions);
        posix_spawnattr_destroy(&attributes);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;
};

// A group of its own, so that a terminal's Ctrl-C reaches us alone and we decide; no blocked or
// ignored signals are handed down.
void plan(SpawnPlan& plan, const Command& command, int output) {
    check(posix_spawn_file_actions_addopen(&plan.actions, 0, "/dev/null", O_RDONLY, 0),
          "/dev/null");
    check(posix_spawn_file_actions_adddup2(&plan.actions, output, 1), "pipe");
    check(posix_spawn_file_actions_adddup2(&plan.actions, output, 2), "pipe");
    if (!command.folder.empty())
        check(posix_spawn_file_actions_addchdir_np(&plan.actions, command.folder.c_str()),
              "working folder");
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&plan.attributes, &none);
    posix_spawnattr_setsigdefault(&plan.attributes, &all);
    posix_spawnattr_setpgroup(&plan.attributes, 0);
    const int flags = POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF;
    check(posix_spawnattr_setflags(&plan.attributes, short(flags)), "posix_spawn");
}

struct Child {
    pid_t id = -1;
    int output = -1;  ///< the pipe's reading end, not blocking
    ~Child() {
        if (output >= 0) close(output);
    }
};

void start(Child& child, const Command& command) {
    int ends[2];
    check(pipe2(ends, O_CLOEXEC) == 0 ? 0 : errno, "pipe");
    child.output = ends[0];
    fcntl(child.output, F_SETFL, O_NONBLOCK);
    std::vector<char*> argv;
    for (const std::string& word : command.argv) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    int error = 0;
    try {
        SpawnPlan how;
        plan(how, command, ends[1]);
        error =
            posix_spawn(&child.id, argv[0], &how.actions, &how.attributes, argv.data(), environ);
    } catch (...) {
        close(ends[1]);
        throw;
    }
    close(ends[1]);
    check(error, command.argv[0].c_str());
}

// Takes what is in the pipe. Without this a talkative child would wait for a reader for ever.
void drain(int pipe, std::string& output) {
    char buffer[1 << 16];
    for (ssize_t n; (n = read(pipe, buffer, sizeof buffer)) > 0;) {
        output.append(buffer, std::size_t(n));
        if (output.size() > 3 * kept_half)
            output = output.substr(0, kept_half) + "\n[...]\n" +
                     output.substr(output.size() - kept_half);
    }
}

// True once the child has ended; it stays a zombie, so that its group's number cannot be reused.
// Where the caller ignores SIGCHLD there are no zombies, and waitid() fails instead.
bool has_ended(pid_t child) {
    siginfo_t info{};
    if (waitid(P_PID, id_t(child), &info, WEXITED | WNOHANG | WNOWAIT) != 0) return errno != EINTR;
    return info.si_pid != 0;
}

double seconds_of(const timeval& time) { return double(time.tv_sec) + double(time.tv_usec) * 1e-6; }

// Waits for the end, or brings it about; tells why it did.
std::optional<Finished::How> attend(const Child& child, const Command& command,
                                    std::string& output) {
    const Clock::time_point begin = Clock::now();
    std::optional<Finished::How> cut_short;
    Clock::time_point kill_at = Clock::time_point::max();
    while (!has_ended(child.id)) {
        pollfd ready = {child.output, POLLIN, 0};
        ::poll(&ready, 1, int(poll_interval.count()));
        drain(child.output, output);
        if ((ready.revents & POLLHUP) != 0 && !has_ended(child.id))
            usleep(10'000);  // it closed its output: poll() no longer waits
        const Clock::time_point now = Clock::now();
        if (!cut_short && command.stop.stop_requested()) cut_short = Finished::How::stopped;
        if (!cut_short && now - begin >= command.timeout) cut_short = Finished::How::timed_out;
        if (cut_short && kill_at == Clock::time_point::max()) {
            kill(-child.id, SIGTERM);
            kill_at = now + grace;
        } else if (now >= kill_at) {
            kill(-child.id, SIGKILL);
        } else if (!cut_short && command.poll) {
            command.poll();
        }
    }
    return cut_short;
}

}  // namespace

Finished run(const Command& command) {
    const Clock::time_point begin = Clock::now();
    Child child;
    start(child, command);

    Finished result;
    std::optional<Finished::How> cut_short;
    const auto reap = [&] {
        kill(-child.id, SIGKILL);  // what the child may have left behind
        int status = 0;
        rusage usage{};
        while (wait4(child.id, &status, 0, &usage) < 0 && errno == EINTR) {
        }
        result.how = WIFSIGNALED(status) ? Finished::How::signalled : Finished::How::exited;
        result.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
        result.cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
    };
    try {
        cut_short = attend(child, command, result.output);
    } catch (...) {  // thrown by poll()
        reap();
        throw;
    }
    reap();
    drain(child.output, result.output);
    if (cut_short) result.how = *cut_short;
    result.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return result;
}

std::filesystem::path find_program(const std::string& name) {
    namespace fs = std::filesystem;
    const auto usable = [](const fs::path& file) {
        std::error_code ignored;
        return fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
    };
    if (name.empty()) return {};
    if (name.find('/') != std::string::npos) return usable(name) ? fs::absolute(name) : fs::path();
    const char* const variable = std::getenv("PATH");
    std::string_view folders = variable ? variable : "/usr/local/bin:/usr/bin:/bin";
    while (true) {
        const std::size_t colon = folders.find(':');
        const fs::path file = fs::path(folders.substr(0, colon)) / name;
        if (usable(file)) return fs::absolute(file);
        if (colon == std::string_view::npos) return {};
        folders.remove_prefix(colon + 1);
    }
}

}  // namespace penumbra
