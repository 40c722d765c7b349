// Whole files, read and written safely.
#pragma once

#include "penumbra/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// Largest file that is read; no model or picture in use comes near it.
inline constexpr std::uintmax_t max_file_size = std::uintmax_t(4) << 30;

/// The system's sentence for an errno, in lower case as the rest of our messages.
std::string system_reason(int error);

/// Throws Error (input) where `size` bytes are too many: "FILE: has N bytes, more than the M that
/// are read".
void check_file_size(std::uintmax_t size, const std::filesystem::path& file,
                     std::uintmax_t max = max_file_size);

/// The content of a regular file. Throws Error (input): "FILE: no such file", "FILE: is a folder",
/// "FILE: is not a regular file", "FILE: has N bytes, more than the M that are read", or the
/// system's reason.
std::string read_text(const std::filesystem::path& file, std::uintmax_t max = max_file_size);
std::vector<std::byte> read_bytes(const std::filesystem::path& file,
                                  std::uintmax_t max = max_file_size);
/// The same of what `descriptor` is open on; `file` is its name for messages.
std::vector<std::byte> read_open(int descriptor, const std::filesystem::path& file,
                                 std::uintmax_t max = max_file_size);

/// Whether both are one file on the disk, by whatever names and links. False where one is missing.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws Error (output) where `file`, which is to be written, is one of `inputs`.
void check_not_input(const std::filesystem::path& file,
                     std::span<const std::filesystem::path> inputs);
/// That Error.
Error input_in_the_way(const std::filesystem::path& file);

/// Writes all of `content` to a descriptor of the system's; returns its error, 0 for none.
int write_all(int out, std::span<const std::byte> content);

/// A file in the making, which takes its name in one step when it is whole. It lies beside that
/// name and, where the file system can, has none of its own until then, so that whatever fails or
/// interrupts leaves what was there. All throw Error (output).
class StagedFile {
  public:
    explicit StagedFile(const std::filesystem::path& file);
    ~StagedFile();
    StagedFile(const StagedFile&) = delete;
    StagedFile& operator=(const StagedFile&) = delete;

    /// Appends.
    void write(std::span<const std::byte> content);
    /// Of the system; open for reading and writing.
    int descriptor() const;
    /// Flushes to the disk and replaces the file. Devices and pipes cannot be replaced; they are
    /// written to.
    void commit();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// Replaces `file` in one step, as a StagedFile. Throws Error (output).
void write_file(const std::filesystem::path& file, std::span<const std::byte> content);
void write_file(const std::filesystem::path& file, std::string_view content);

}  // namespace penumbra
