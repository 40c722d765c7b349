#include "base/memory.h"

#include "base/descriptor.h"
#include "base/text/utf8.h"

#include "penumbra/limits.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <optional>
#include <span>
#include <utility>

namespace penumbra {
namespace {

constexpr std::size_t unlimited = std::size_t(-1);
constexpr std::size_t most_of_all = unlimited / 2;  // no vector can be larger

std::atomic<std::size_t> limit = 0;    // 0: none
std::atomic<std::size_t> claimed = 0;  // by all MemoryClaims there are
// What was asked for since the process was looked at: many small things are a large one.
std::atomic<std::size_t> unseen = 0;
constexpr std::size_t worth_a_look = std::size_t(1) << 20;

// The beginning of a file of the system's; empty where there is none.
std::string_view start_of(const char* file, std::span<char> buffer) {
    const Descriptor in(::open(file, O_RDONLY | O_CLOEXEC));
    if (!in) return {};
    const ssize_t size = ::read(in.get(), buffer.data(), buffer.size());
    return {buffer.data(), std::size_t(std::max<ssize_t>(size, 0))};
}

std::optional<std::size_t> number_in(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\n"), text.size()));
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) return {};
    return value;
}

// The number behind `key` at the start of a line.
std::optional<std::size_t> number_after(std::string_view text, std::string_view key) {
    for (auto at = text.find(key); at != text.npos; at = text.find(key, at + 1))
        if (at == 0 || text[at - 1] == '\n') return number_in(text.substr(at + key.size()));
    return {};
}

// Memory that is the process's own: not what it shares with the files it has mapped.
std::size_t used() {
    std::array<char, 256> buffer;
    std::string_view text = start_of("/proc/self/statm", buffer);
    std::array<std::size_t, 3> pages = {};  // size, resident, shared
    for (std::size_t& number : pages) {
        number = number_in(text).value_or(0);
        text.remove_prefix(std::min(text.find(' ') + 1, text.size()));
    }
    static const auto page = std::size_t(::sysconf(_SC_PAGESIZE));
    return (pages[1] - std::min(pages[1], pages[2])) * page;
}

// What one control group leaves; what it holds of files can be given up.
std::size_t left_in_group(const std::string& folder, bool second_version) {
    std::array<char, 1 << 13> buffer;
    const auto number = [&](const char* name) {
        return number_in(start_of((folder + name).c_str(), buffer));
    };
    const auto most = number(second_version ? "/memory.max" : "/memory.limit_in_bytes");
    const auto now = number(second_version ? "/memory.current" : "/memory.usage_in_bytes");
    if (!most || !now) return unlimited;
    const std::string_view details = start_of((folder + "/memory.stat").c_str(), buffer);
    const std::size_t files =
        number_after(details, second_version ? "inactive_file " : "total_inactive_file ")
            .value_or(0);
    const std::size_t taken = *now - std::min(*now, files);
    return *most - std::min(*most, taken);
}

// The same of a group and all around it. In a container the path may be that of the outside.
std::size_t left_in_groups(const std::string& root, std::string path, bool second_version) {
    std::size_t left = left_in_group(root, second_version);
    for (; path.size() > 1; path.resize(path.rfind('/')))
        left = std::min(left, left_in_group(root + path, second_version));
    return left;
}

// cgroups(7): lines of "number:controllers:path".
std::size_t left_in_own_groups() {
    std::array<char, 1 << 13> buffer;
    std::string_view lines = start_of("/proc/self/cgroup", buffer);
    std::size_t left = unlimited;
    while (!lines.empty()) {
        const std::string_view line = lines.substr(0, lines.find('\n'));
        lines.remove_prefix(std::min(line.size() + 1, lines.size()));
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (second == line.npos || line.substr(second + 1, 1) != "/") continue;
        const std::string path(line.substr(second + 1));
        const std::string_view controllers = line.substr(first + 1, second - first - 1);
        if (controllers.empty())
            left = std::min(left, left_in_groups("/sys/fs/cgroup", path, true));
        else if (controllers == "memory")
            left = std::min(left, left_in_groups("/sys/fs/cgroup/memory", path, false));
    }
    return left;
}

// What is in use, with `bytes` more. Looks at the process where that may matter.
bool fits(std::size_t bytes, std::size_t most) {
    const std::size_t others = claimed;
    return bytes <= most && others <= most - bytes && used() <= most - bytes - others;
}

bool may_take(std::size_t bytes) {
    if (limit == 0) return bytes <= most_of_all;
    if (bytes < worth_a_look && unseen.fetch_add(bytes) + bytes < worth_a_look) return true;
    unseen = 0;
    const std::size_t most = memory_limit();
    if (fits(bytes, most)) return true;
    ::malloc_trim(0);  // what was freed may still be counted
    return fits(bytes, most);
}

}  // namespace

void set_memory_limit(std::size_t bytes) { limit = bytes; }

std::size_t memory_limit() { return limit; }

std::size_t free_memory() {
    std::array<char, 1 << 12> buffer;
    const auto machine = number_after(start_of("/proc/meminfo", buffer), "MemAvailable:");
    std::size_t left = machine ? *machine * 1024 : unlimited;
    left = std::min(left, left_in_own_groups());
    for (const auto resource : {RLIMIT_DATA, RLIMIT_AS}) {
        rlimit bound{};
        if (::getrlimit(resource, &bound) == 0 && bound.rlim_cur != RLIM_INFINITY)
            left = std::min(left, std::size_t(bound.rlim_cur));
    }
    return left == unlimited ? 0 : left;
}

bool memory_is_left(std::size_t bytes) noexcept { return may_take(bytes); }

MemoryClaim::MemoryClaim(std::size_t bytes, const std::string& place) : bytes_(bytes) {
    if (!may_take(bytes)) {
        bytes_ = 0;
        const std::size_t most = limit == 0 ? most_of_all : limit.load(), taken = used() + claimed;
        throw MemoryError(Failure::input, place,
                          fmt::format("needs {} of memory, more than the {} that are left of {}",
                                      memory_text(bytes), memory_text(most - std::min(most, taken)),
                                      memory_text(most)));
    }
    claimed += bytes;
}

MemoryClaim& MemoryClaim::operator=(MemoryClaim&& other) noexcept {
    release();
    std::swap(bytes_, other.bytes_);
    return *this;
}

void MemoryClaim::release() noexcept {
    claimed -= bytes_;
    bytes_ = 0;
}

std::string memory_text(std::size_t bytes) {
    constexpr double mega = 1024.0 * 1024.0, giga = mega * 1024.0;
    const auto size = double(bytes);
    if (size >= giga) return fmt::format("{:.1f} GB", size / giga);
    if (size >= mega) return fmt::format("{:.0f} MB", size / mega);
    return fmt::format("{} bytes", bytes);
}

std::string kept_name(std::string_view name) {
    if (name.size() <= max_name) return std::string(name);
    constexpr std::string_view mark = "...";
    return std::string(utf8_start(name, max_name - mark.size())).append(mark);
}

}  // namespace penumbra
