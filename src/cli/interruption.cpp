#include "cli/interruption.h"

#include "base/descriptor.h"

#include "penumbra/error.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>

namespace penumbra::cli {
namespace {

constexpr std::array signals = {SIGINT, SIGTERM, SIGHUP};
constexpr int patience = 600;  // milliseconds
constexpr int exit_interrupted = 130;

// A handler may do little more than write to a pipe; a thread at its other end does the rest.
std::array<Descriptor, 2> ends;

std::mutex leftover_mutex;
std::filesystem::path leftover;

extern "C" void note_signal(int) {
    const int saved = errno;
    const char byte = 's';
    [[maybe_unused]] const auto ignored = ::write(ends[1].get(), &byte, 1);
    errno = saved;
}

// 's': a signal came; 'e' or nothing: the program ends by itself.
char next_byte() {
    char byte = 'e';
    while (::read(ends[0].get(), &byte, 1) < 0 && errno == EINTR) {
    }
    return byte;
}

// Ends the process while its work still goes on.
[[noreturn]] void end_now() {
    const std::lock_guard lock(leftover_mutex);  // for good: nobody may fill it again
    std::error_code error;
    if (!leftover.empty()) std::filesystem::remove_all(leftover, error);
    constexpr char message[] = "penumbra: error: interrupted\n";
    [[maybe_unused]] const auto ignored = ::write(STDERR_FILENO, message, sizeof message - 1);
    ::_exit(exit_interrupted);
}

void watch(const std::stop_source& source) {
    if (next_byte() != 's') return;
    source.request_stop();
    pollfd end = {ends[0].get(), POLLIN, 0};
    if (::poll(&end, 1, patience) > 0 && next_byte() == 'e') return;  // else impatience
    end_now();
}

void handle(void (*handler)(int)) {
    struct sigaction action{};
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    for (const int number : signals) {
        struct sigaction before{};
        sigaction(number, nullptr, &before);
        if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);  // nohup stays
    }
}

}  // namespace

void set_leftover(const std::filesystem::path& folder) {
    const std::lock_guard lock(leftover_mutex);
    leftover = folder;
}

void remove_leftover() {
    const std::lock_guard lock(leftover_mutex);
    std::error_code ignored;
    if (!leftover.empty()) std::filesystem::remove_all(leftover, ignored);
    leftover.clear();
}

Interruption::Interruption() {
    std::array<int, 2> pipe = {};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
        throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
    ends = {Descriptor(pipe[0]), Descriptor(pipe[1])};
    ::fcntl(ends[1].get(), F_SETFL, O_NONBLOCK);
    watcher_ = std::jthread(watch, source_);
    handle(note_signal);
}

Interruption::~Interruption() {
    handle(SIG_DFL);
    const char byte = 'e';
    [[maybe_unused]] const auto ignored = ::write(ends[1].get(), &byte, 1);
    watcher_.join();
    for (Descriptor& end : ends) end.close();
}

}  // namespace penumbra::cli
