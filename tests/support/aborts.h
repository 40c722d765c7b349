// Whether a precondition is asserted.
#pragma once

#include "support/support.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace test {

/// Does `work` end in abort(), as a failed assert() does? It runs in a process of its own, and must
/// start no threads before that.
template <class Work>
bool aborts(const Work& work) {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        // Neither Catch's report nor the assertion's sentence.
        std::signal(SIGABRT, SIG_DFL);
        const int nowhere = ::open("/dev/null", O_WRONLY);
        ::dup2(nowhere, STDOUT_FILENO);
        ::dup2(nowhere, STDERR_FILENO);
        work();
        ::_exit(0);
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT;
}

}  // namespace test
