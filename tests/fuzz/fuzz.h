// What the fuzz targets share. A target is a function of one input, which libFuzzer makes up
// (libfuzzer.cpp) or which is read from a file (replay.cpp).
#pragma once

#include "penumbra/importers.h"

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace fuzz {

using Input = std::string_view;

struct Target {
    const char* name;
    void (*run)(Input);
};

std::span<const Target> targets();

/// nullptr when there is none.
const Target* target_named(std::string_view name);

// The targets; the layout of their inputs is told in README.md.
void gltf(Input input);
void glb(Input input);
void obj(Input input);
void mtl(Input input);
void sidecar(Input input);
void compare(Input input);

/// A rule is broken: says so and aborts, as a crash would.
[[noreturn]] void finding(const std::string& what);

/// Runs `work`, which may refuse its input: throw an Error (input or usage) with a presentable
/// message, or std::bad_alloc at the memory cap. All else is a finding. Was it not refused?
bool may_refuse(const std::function<void()>& work);

/// A finding when `text` is more than one line or has control characters, those of UTF-8 included.
void check_presentable(std::string_view text, const char* what);

/// What holds for every scene that load_scene() returns; then export and rendering, as far as they
/// take no time.
void check_scene(penumbra::Imported imported);

/// Did operator new refuse anything in this input?
bool memory_cap_reached();

/// No input needs so much memory at once.
inline constexpr std::size_t memory_cap = std::size_t(512) << 20;

/// What the library is told to keep to; the rest of the sanitizers' memory is theirs.
inline constexpr std::size_t process_limit = std::size_t(2) << 30;

/// Forgets what the last input allocated and did not free.
void start_memory_count();

/// A folder of this process with a few images and models that inputs may name. It lies in memory,
/// and what is outside of its folder `in` must not be read.
struct Sandbox {
    std::filesystem::path in, out;

    Sandbox();
    ~Sandbox();
    Sandbox(const Sandbox&) = delete;
    Sandbox& operator=(const Sandbox&) = delete;

    /// Replaces `in / name`.
    std::filesystem::path write(const char* name, Input content) const;

  private:
    std::filesystem::path top_;
};

const Sandbox& sandbox();

}  // namespace fuzz
