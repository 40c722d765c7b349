// operator new with a cap, so that an input that asks for terabytes is refused as on a small
// machine: by std::bad_alloc. The sanitizers still see every malloc() and free() below it.
#include "fuzz.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> live = 0;
std::atomic<bool> refused = false;

void* allocate(std::size_t size, std::size_t alignment) {
    if (size > fuzz::memory_cap || live + size > fuzz::memory_cap) {
        refused = true;
        return nullptr;
    }
    void* memory = nullptr;
    if (alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__)
        memory = std::malloc(size == 0 ? 1 : size);
    else if (::posix_memalign(&memory, alignment, size) != 0)
        return nullptr;
    if (memory != nullptr) live += ::malloc_usable_size(memory);
    return memory;
}

void* allocate_or_throw(std::size_t size, std::size_t alignment) {
    void* const memory = allocate(size, alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

// What libraries got before this file was ready, or from malloc(), is not in the count.
void release(void* memory) {
    if (memory == nullptr) return;
    const std::size_t size = ::malloc_usable_size(memory);
    std::size_t before = live;
    while (!live.compare_exchange_weak(before, before - std::min(before, size))) {
    }
    std::free(memory);
}

}  // namespace

namespace fuzz {

bool memory_cap_reached() { return refused; }

void start_memory_count() {
    live = 0;
    refused = false;
}

}  // namespace fuzz

// NOLINTBEGIN(misc-new-delete-overloads)
void* operator new(std::size_t size) { return allocate_or_throw(size, 0); }
void* operator new[](std::size_t size) { return allocate_or_throw(size, 0); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size, 0); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return allocate(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate_or_throw(size, std::size_t(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return allocate_or_throw(size, std::size_t(alignment));
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
    return allocate(size, std::size_t(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
    return allocate(size, std::size_t(alignment));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
    release(memory);
}
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
    release(memory);
}
// NOLINTEND(misc-new-delete-overloads)
