// Rows of an unfinished picture in a file, so that an interrupted rendering can go on.
#pragma once

#include "base/descriptor.h"

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

    /// What is there.
    struct Found {
        enum class Kind {
            nothing,  ///< no file, or one that was only begun
            rows,     ///< of this picture, which restore() hands on
            other,    ///< a checkpoint, but of another picture
            in_use,   ///< by another process
            foreign,  ///< not a checkpoint
        };
        Kind kind = Kind::nothing;
        int first = 0;              ///< the first of the rows
        std::string identity = {};  ///< of the other picture; empty where another version wrote it
    };
    /// Keeps the file for restore() if it has rows.
    Found open();
    /// After open(): hands on what the file has, in order, as it was given to append(), and keeps
    /// it for more.
    void restore(const std::function<void(std::span<const std::byte>)>& take);

    /// Begins the file with these rows, unless it ends where they begin; an older one is replaced.
    /// False when that fails: then there is no file any more, and none will be made.
    bool append(const RowRange& rows, std::span<const std::byte> samples);

    /// The picture is finished, or must begin anew.
    void remove();

    bool exists() const { return bool(descriptor_); }

    /// The row behind those that the file has.
    int end() const { return next_; }

    /// Removes what an earlier process has left there of any picture, unless it is in use.
    static void remove_stale(const std::filesystem::path& file);

  private:
    struct Piece;
    std::optional<Piece> read_piece(std::vector<std::byte>& samples) const;
    bool open_locked();              ///< errno says why not
    std::string first_line() const;  ///< with its line feed; empty: there is none yet
    bool begin();
    bool is_ours() const;  ///< a checkpoint, whatever of, or empty
    bool read(std::span<std::byte> to) const;

    std::filesystem::path file_;
    std::string head_;
    std::size_t row_size_;
    int height_;
    Descriptor descriptor_;
    int next_ = 0;
    bool failed_ = false;
};

}  // namespace penumbra
