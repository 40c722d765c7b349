// Rows of an unfinished picture in a file, so that an interrupted rendering can go on.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace penumbra {

/// What belongs to a picture that is not the one wanted, or is damaged, is never taken.
class Checkpoint {
  public:
    /// `identity`, one line, tells pictures apart. Nothing is read or written yet.
    Checkpoint(std::filesystem::path file, const std::string& identity);
    ~Checkpoint();
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;

    /// Hands on what the file has of this picture, in order, as it was given to append(), and keeps
    /// it for more. Returns false when there is a file, but of another picture or in use.
    bool restore(const std::function<void(std::span<const std::byte>)>& take);

    /// Makes the file if it is not there; without restore() an older one is replaced. False when
    /// that fails: then there is no file any more, and none will be made.
    bool append(std::span<const std::byte> samples);

    /// The picture is finished, or must begin anew.
    void remove();

    bool exists() const { return descriptor >= 0; }

    /// Removes what an earlier process has left there of any picture, unless it is in use.
    static void remove_stale(const std::filesystem::path& file);

  private:
    bool open_locked();
    bool begin();
    bool is_ours() const;  ///< a checkpoint, whatever of, or empty
    bool read(std::span<std::byte> to) const;
    void close();

    std::filesystem::path file;
    std::string head;
    int descriptor = -1;
    bool failed = false;
};

}  // namespace penumbra
