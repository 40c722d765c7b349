// A batch survives the crash of one of its jobs: it is worked on in a process of its own.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace penumbra::cli {

/// How far each job of a batch is, in memory that outlives the process that works on them.
class Progress {
  public:
    enum State : int {
        open,
        running,        ///< beside others
        running_alone,  ///< so that a crash is its own
        suspect,        ///< was running when the process crashed
        done,
        crashed,
    };

    Progress();
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Jobs beyond `most` share the last place, and are not told apart.
    std::atomic<int>& operator[](std::size_t job) { return states_[job < most ? job : most - 1]; }

    /// Whom a crash concerns: what was running beside others becomes a suspect, what was running
    /// alone has crashed. False when nothing was running.
    bool note_crash();

  private:
    static constexpr std::size_t most = 1 << 16;
    std::atomic<int>* states_ = nullptr;
};

/// Runs `work` in a child process, again after every crash in which a job was running, and returns
/// its exit status. Signals that the process gets are handed on. Precondition: no other thread
/// runs. Throws std::system_error; std::runtime_error when the child crashes otherwise.
int supervise(Progress& progress, const std::function<int()>& work);

}  // namespace penumbra::cli
