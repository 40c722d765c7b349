#include "base/temporary.h"

#include "base/hash.h"
#include "base/text/ascii.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

// Names of hosts may be long, those of files have an end.
constexpr std::size_t longest_host = 24;

std::string host_name() {
    std::array<char, 256> name = {};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

// Within it a number belongs to one process at most: the host, its start, and the container.
std::string machine_mark() {
    const std::string host = host_name();
    std::ifstream boot_id("/proc/sys/kernel/random/boot_id");
    std::string boot;
    std::getline(boot_id, boot);
    std::error_code ignored;
    Hash hash;
    hash.add(host);
    hash.add(boot);
    hash.add(fs::read_symlink("/proc/self/ns/pid", ignored).native());
    std::string mark = host.substr(0, longest_host);
    for (char& c : mark) {
        if (!is_letter_or_digit(c) && c != '-') c = '_';
    }
    return mark + '-' + text_of(hash.digest()).substr(0, 8) + '.';
}

const std::string& machine() {
    static const std::string mark = machine_mark();
    return mark;
}

// Whether `rest` is "<id>.tmp" or "<id>-<number>.tmp" of a process that is gone.
bool is_left_behind(std::string_view rest) {
    pid_t process = 0;
    const char* const end = rest.data() + rest.size() - 4;
    auto [stop, wrong] = std::from_chars(rest.data(), end, process);
    if (wrong != std::errc{} || process <= 0) return false;
    unsigned count = 0;
    if (stop != end && *stop == '-') stop = std::from_chars(stop + 1, end, count).ptr;
    return stop == end && ::kill(process, 0) != 0 && errno == ESRCH;
}

}  // namespace

std::string process_mark() { return machine() + std::to_string(::getpid()); }

void remove_stale(const fs::path& folder, const std::string& prefix) {
    const std::string ours = prefix + machine();
    std::error_code error;
    std::vector<fs::path> stale;
    fs::directory_iterator at(folder.empty() ? "." : folder, error);
    for (; !error && at != fs::directory_iterator(); at.increment(error)) {
        const std::string name = at->path().filename().string();
        if (name.starts_with(ours) && name.ends_with(".tmp") &&
            is_left_behind(std::string_view(name).substr(ours.size())))
            stale.push_back(at->path());
    }
    for (const fs::path& path : stale) fs::remove_all(path, error);
}

}  // namespace penumbra
