#include "cli/supervisor.h"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

namespace penumbra::cli {
namespace {

constexpr std::array signals = {SIGINT, SIGTERM, SIGHUP};

std::atomic<pid_t> child = 0;

// A terminal's Ctrl-C reaches the child by itself, another process's signal only us.
extern "C" void hand_on(int number, siginfo_t* info, void*) {
    const int saved = errno;
    const pid_t to = child;
    if (to > 0 && info->si_code <= 0) ::kill(to, number);
    errno = saved;
}

void handle(void (*handler)(int, siginfo_t*, void*)) {
    struct sigaction action{};
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART | (handler != nullptr ? SA_SIGINFO : 0);
    if (handler != nullptr)
        action.sa_sigaction = handler;
    else
        action.sa_handler = SIG_DFL;
    for (const int number : signals) {
        struct sigaction before{};
        sigaction(number, nullptr, &before);
        if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);  // nohup stays
    }
}

[[noreturn]] void be_child(pid_t parent, const std::function<int()>& work) {
    handle(nullptr);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(1);  // it was killed meanwhile
    const int status = work();
    std::fflush(nullptr);
    ::_exit(status);
}

int wait_for(pid_t process) {
    int status = 0;
    while (::waitpid(process, &status, 0) < 0)
        if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waitpid");
    return status;
}

}  // namespace

Progress::Progress() {
    void* const memory = ::mmap(nullptr, most * sizeof(std::atomic<int>), PROT_READ | PROT_WRITE,
                                MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::system_error(errno, std::generic_category(), "mmap");
    static_assert(std::atomic<int>::is_always_lock_free && int(open) == 0);
    states_ = static_cast<std::atomic<int>*>(memory);  // zeros
}

Progress::~Progress() { ::munmap(states_, most * sizeof(std::atomic<int>)); }

bool Progress::note_crash() {
    bool any = false;
    for (std::size_t i = 0; i < most; ++i) {
        const int state = states_[i];
        if (state != running && state != running_alone) continue;
        states_[i] = state == running ? suspect : crashed;
        any = true;
    }
    return any;
}

int supervise(Progress& progress, const std::function<int()>& work) {
    const pid_t self = ::getpid();
    handle(hand_on);
    while (true) {
        std::fflush(nullptr);
        const pid_t started = ::fork();
        if (started < 0) throw std::system_error(errno, std::generic_category(), "fork");
        if (started == 0) be_child(self, work);
        child = started;
        const int status = wait_for(started);
        child = 0;
        if (WIFEXITED(status)) {
            handle(nullptr);
            return WEXITSTATUS(status);
        }
        if (!progress.note_crash())
            throw std::runtime_error(std::string("ended by signal ") +
                                     std::to_string(WTERMSIG(status)) + " (" +
                                     ::strsignal(WTERMSIG(status)) + ")");
    }
}

}  // namespace penumbra::cli
