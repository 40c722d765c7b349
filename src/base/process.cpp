#include "base/process.h"

#include "base/descriptor.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

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

struct Child {
    pid_t id = -1;
    Descriptor output = {};  ///< the pipe's reading end, not blocking
};

// What a new process needs to become the program.
struct Launch {
    std::vector<char*> argv = {}, environment = {};
    std::vector<std::string> variables = {};  // that `environment` points to
    const char* folder = nullptr;
    int output = -1, failure = -1;  // writing ends of pipes; of the second: errno of what failed
    pid_t parent = -1;
    std::optional<rlim_t> memory = {};
    rlim_t seconds = RLIM_INFINITY;
};

rlim_t processors() { return rlim_t(std::max(sysconf(_SC_NPROCESSORS_ONLN), 1L)); }

void set_environment(const Command& command, Launch& launch) {
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view text = *variable;
        if (!command.environment.contains(std::string(text.substr(0, text.find('=')))))
            launch.environment.push_back(*variable);
    }
    for (const auto& [name, value] : command.environment)
        if (!value.empty()) launch.variables.push_back(name + '=' + value);
    for (std::string& variable : launch.variables) launch.environment.push_back(variable.data());
    launch.environment.push_back(nullptr);
}

Launch make_launch(const Command& command, int output, int failure) {
    Launch launch;
    launch.output = output;
    launch.failure = failure;
    launch.parent = getpid();
    for (const std::string& word : command.argv)
        launch.argv.push_back(const_cast<char*>(word.c_str()));
    launch.argv.push_back(nullptr);
    set_environment(command, launch);
    if (!command.folder.empty()) launch.folder = command.folder.c_str();
    // RLIMIT_DATA counts threads' stacks, filled or not.
    constexpr std::size_t stacks = std::size_t(64) << 20, stack = std::size_t(16) << 20;
    if (command.memory != 0) launch.memory = rlim_t(command.memory) + stacks + stack * processors();
    using std::chrono::seconds;
    launch.seconds = rlim_t(std::chrono::ceil<seconds>(command.timeout).count() + 1) * processors();
    return launch;
}

void lower(decltype(RLIMIT_DATA) resource, std::optional<rlim_t> most) {
    rlimit bound{};
    if (getrlimit(resource, &bound) != 0) return;
    // Ours, if we have one, is not the program's.
    bound.rlim_cur = most ? std::min(*most, bound.rlim_max) : bound.rlim_max;
    setrlimit(resource, &bound);
}

bool connect(const Launch& launch) {
    const int nothing = open("/dev/null", O_RDONLY);
    return nothing >= 0 && dup2(nothing, 0) >= 0 && dup2(launch.output, 1) >= 0 &&
           dup2(launch.output, 2) >= 0 && (nothing == 0 || close(nothing) == 0) &&
           (launch.folder == nullptr || chdir(launch.folder) == 0);
}

// A group of its own, so that a terminal's Ctrl-C reaches us alone and we decide; no blocked or
// ignored signals are handed down. Behind fork() only what is safe in a signal handler may be
// called: other threads may have held any lock.
[[noreturn]] void become(const Launch& launch) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != launch.parent) _exit(127);  // it has ended meanwhile
    lower(RLIMIT_DATA, launch.memory);
    lower(RLIMIT_CPU, launch.seconds);
    if (connect(launch)) {
        struct sigaction plain{};
        plain.sa_handler = SIG_DFL;
        for (int number = 1; number < NSIG; ++number) sigaction(number, &plain, nullptr);
        sigset_t none;
        sigemptyset(&none);
        sigprocmask(SIG_SETMASK, &none, nullptr);
        execve(launch.argv[0], launch.argv.data(), launch.environment.data());
    }
    const int error = errno;
    [[maybe_unused]] const ssize_t written = write(launch.failure, &error, sizeof error);
    _exit(127);
}

// With all signals blocked, for their handlers are ours until the program runs.
pid_t fork_to(const Launch& launch) {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const pid_t child = fork();
    if (child == 0) become(launch);
    const int error = errno;
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    errno = error;
    return child;
}

struct Pipe {
    Descriptor reading, writing;
    Pipe() {
        int ends[2] = {-1, -1};
        check(pipe2(ends, O_CLOEXEC) == 0 ? 0 : errno, "pipe");
        reading = Descriptor(ends[0]);
        writing = Descriptor(ends[1]);
    }
};

void start(Child& child, const Command& command) {
    Pipe output, failure;
    const Launch launch = make_launch(command, output.writing.get(), failure.writing.get());
    child.id = fork_to(launch);
    check(child.id < 0 ? errno : 0, command.argv[0].c_str());
    failure.writing.close();
    int error = 0;
    ssize_t size = 0;  // nothing once the program runs, which closes its end
    while ((size = read(failure.reading.get(), &error, sizeof error)) < 0 && errno == EINTR) {
    }
    if (size != 0) waitpid(child.id, nullptr, 0);
    check(size != 0 ? error : 0, command.argv[0].c_str());
    child.output = std::move(output.reading);
    fcntl(child.output.get(), F_SETFL, O_NONBLOCK);
}

// Takes what is in the pipe. Without this a talkative child would wait for a reader for ever.
void drain(int pipe, std::string& output) {
    char buffer[1 << 16];
    for (ssize_t n = 0; (n = read(pipe, buffer, sizeof buffer)) > 0;) {
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

// C++ programs say so of an exception that they do not catch; others are seen to have taken much.
bool is_out_of_memory(const Command& command, const Finished& finished, const rusage& usage) {
    const bool failed = finished.how == Finished::How::signalled || finished.code != 0;
    if (command.memory == 0 || !failed) return false;
    const auto said = [&](const char* words) {
        return finished.output.find(words) != std::string::npos;
    };
    return said("std::bad_alloc") || said("ut of memory") || said("emory exhausted") ||
           said("Cannot allocate memory") ||
           std::size_t(usage.ru_maxrss) * 1024 >= command.memory / 10 * 9;
}

double seconds_of(const timeval& time) { return double(time.tv_sec) + double(time.tv_usec) * 1e-6; }

// Waits for the end, or brings it about; tells why it did.
std::optional<Finished::How> attend(const Child& child, const Command& command,
                                    std::string& output) {
    const Clock::time_point begin = Clock::now();
    std::optional<Finished::How> cut_short;
    Clock::time_point kill_at = Clock::time_point::max();
    while (!has_ended(child.id)) {
        pollfd ready = {child.output.get(), POLLIN, 0};
        ::poll(&ready, 1, int(poll_interval.count()));
        drain(child.output.get(), output);
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
        drain(child.output.get(), result.output);
        result.out_of_memory = is_out_of_memory(command, result, usage);
    };
    try {
        cut_short = attend(child, command, result.output);
    } catch (...) {  // thrown by poll()
        reap();
        throw;
    }
    reap();
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
