// The owner of a file descriptor of the system's.
#pragma once

#include <unistd.h>

#include <utility>

namespace penumbra {

/// Closes it on every way out.
class Descriptor {
  public:
    Descriptor() = default;
    /// `number` as open() and its like return it: -1 where that failed.
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        other.close();
        return *this;
    }
    ~Descriptor() { close(); }

    explicit operator bool() const { return number_ >= 0; }
    int get() const { return number_; }

    void close() noexcept {
        if (number_ >= 0) ::close(std::exchange(number_, -1));
    }

  private:
    int number_ = -1;
};

}  // namespace penumbra
