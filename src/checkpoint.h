// Rows of an unfinished picture in a file, so that an interrupted rendering can go on.
#pragma once

#include "penumbra/tracer.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// What belongs to a picture that is not the one wanted, or is damaged, is never taken. The rows
/// follow one another, but need not begin with the first.
class Checkpoint {
  public:
    /// `identity`, one line, tells pictures apart; they have `height` rows of `row_size` bytes.
    /// Nothing is read or written yet.
    Checkpoint(std::filesystem::path file, const std::string& identity, std::size_t row_size,
               int height);
    ~Checkpoint();
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;

    /// Keeps the file for restore(), if there is one, and returns the first row that it has; 0
    /// without a file. None when there is one, but of another picture or in use.
    std::optional<int> open();
    /// After open(): hands on what the file has, in order, as it was given to append(), and keeps
    /// it for more.
    void restore(const std::function<void(std::span<const std::byte>)>& take);

    /// Begins the file with these rows, unless it ends where they begin; an older one is replaced.
    /// False when that fails: then there is no file any more, and none will be made.
    bool append(const RowRange& rows, std::span<const std::byte> samples);

    /// The picture is finished, or must begin anew.
    void remove();

    bool exists() const { return descriptor >= 0; }

    /// The row behind those that the file has.
    int end() const { return next; }

    /// Removes what an earlier process has left there of any picture, unless it is in use.
    static void remove_stale(const std::filesystem::path& file);

  private:
    struct Piece;
    std::optional<Piece> read_piece(std::vector<std::byte>& samples) const;
    bool open_locked();
    bool begin();
    bool is_ours() const;  ///< a checkpoint, whatever of, or empty
    bool read(std::span<std::byte> to) const;
    void close();

    std::filesystem::path file;
    std::string head;
    std::size_t row_size;
    int height;
    int descriptor = -1;
    int next = 0;
    bool failed = false;
};

}  // namespace penumbra
