// The program as its users run it: arguments in; exit status, standard output, standard error and
// files out.
#pragma once

#include "support/support.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <map>
#include <sstream>
#include <thread>
#include <vector>

namespace test {

using Words = std::vector<std::string>;

struct Ended {
    int status = -1;  // of exit; -signal when killed
    std::string out = {}, err = {};
    std::size_t peak = 0;  // bytes of memory
};

// A run of the program in `folder`, with standard output and error in files beside it.
struct Running {
    pid_t pid = -1;
    TempDir logs = {};

    Running(const fs::path& folder, const Words& words,
            const std::map<std::string, std::string>& variables = {}) {
        Words arguments = {PENUMBRA_PROGRAM};
        arguments.insert(arguments.end(), words.begin(), words.end());
        Words environment = {"PATH=" + std::string(std::getenv("PATH")), "TERM=xterm"};
        for (const auto& [name, value] : variables) environment.push_back(name + "=" + value);

        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        const int flags = O_WRONLY | O_CREAT | O_TRUNC;
        posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, 1, (logs / "out").c_str(), flags, 0600);
        posix_spawn_file_actions_addopen(&actions, 2, (logs / "err").c_str(), flags, 0600);
        posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
        const int error = posix_spawn(&pid, PENUMBRA_PROGRAM, &actions, nullptr,
                                      pointers(arguments).data(), pointers(environment).data());
        posix_spawn_file_actions_destroy(&actions);
        REQUIRE(error == 0);
    }

    Ended wait() {
        int status = 0;
        rusage usage{};
        wait4(pid, &status, 0, &usage);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status),
                test::read(logs / "out"), test::read(logs / "err"),
                std::size_t(usage.ru_maxrss) * 1024};
    }

    // Before this a signal would end the program at once, as any other.
    void wait_until_it_handles(int number) const {
        for (int i = 0; i < 1000; ++i) {
            const std::string status = test::read("/proc/" + std::to_string(pid) + "/status");
            const auto at = status.find("SigCgt:");
            if (at != std::string::npos &&
                (std::stoull(status.substr(at + 7), nullptr, 16) >> (number - 1) & 1) != 0)
                return;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        FAIL("the program never handled the signal");
    }

  private:
    static std::vector<char*> pointers(Words& words) {
        std::vector<char*> list;
        for (std::string& word : words) list.push_back(word.data());
        list.push_back(nullptr);
        return list;
    }
};

inline Ended run(const fs::path& folder, const Words& words,
                 const std::map<std::string, std::string>& variables = {}) {
    return Running(folder, words, variables).wait();
}

inline constexpr const char* small_scene = R"([render]
size = [32, 24]
[camera]
position = [0, 1, 6]
look_at = [0, 1, 0]
[[light]]
type = "point"
position = [3, 5, 4]
[[sphere]]
center = [0, 1, 0]
radius = 1
material = "red"
[[plane]]
material = "floor"
[material.red]
color = [0.8, 0.1, 0.1]
reflection = 0.2
[material.floor]
color = [0.5, 0.5, 0.6]
)";

inline constexpr const char* cube_corner = R"(v 0 0 0
v 2 0 0
v 0 3 0
v 0 0 4
f 1 2 3
f 1 3 4
)";

// A picture of one colour, as text.
inline std::string ppm(int width, int height, int level) {
    std::string text = "P3\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
    for (int i = 0; i < width * height; ++i)
        for (int c = 0; c < 3; ++c)
            text += std::to_string((i * 37 + c * 11) % 200 * level / 100) + "\n";
    return text;
}

inline std::size_t entries(const fs::path& folder) {
    return std::size_t(std::distance(fs::directory_iterator(folder), {}));
}

inline bool has_povray() {
    const char* const path = std::getenv("PATH");
    std::stringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((folder + "/povray").c_str(), X_OK) == 0) return true;
    return false;
}

}  // namespace test
