// Accessors -> numbers.
#include "importers/gltf/document/accessor.h"

#include "base/parallel.h"
#include "importers/gltf/document/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace penumbra::gltf {
namespace {

// Elements of one type at a regular distance in a buffer.
struct StridedElements {
    const std::byte* data = nullptr;
    std::size_t stride = 0;
    int component_type = 0;
    bool normalized = false;
};

template <class T>
T load(const std::byte* from) {
    T value;
    std::memcpy(&value, from, sizeof value);  // the file may be misaligned
    return value;
}

// glTF 2.0, section 3.6.2.2 (as OpenGL): signed values are c / (2^(b-1) - 1), at least -1.
template <class T>
float as_float(T value, bool normalized) {
    if constexpr (std::is_same_v<T, float>) return value;
    if constexpr (std::is_same_v<T, double>) {
        constexpr double largest = std::numeric_limits<float>::max();
        return std::abs(value) > largest ? std::numeric_limits<float>::infinity() : float(value);
    }
    if (!normalized) return float(value);
    const float fraction = float(double(value) / double(std::numeric_limits<T>::max()));
    return std::max(fraction, -1.0F);
}

// Calls `work` with a value of the component's C++ type.
template <class Work>
void with_component(int type, Work&& work) {
    switch (type) {
    // NOLINTNEXTLINE(bugprone-branch-clone): every branch is of another type
    case TINYGLTF_COMPONENT_TYPE_BYTE: return work(std::int8_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return work(std::uint8_t());
    case TINYGLTF_COMPONENT_TYPE_SHORT: return work(std::int16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return work(std::uint16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return work(std::uint32_t());
    case TINYGLTF_COMPONENT_TYPE_DOUBLE: return work(double());
    default: return work(float());
    }
}

template <class Number, class T>
Number as_number(T value, bool normalized) {
    if constexpr (std::is_same_v<Number, T>) return value;
    return Number(as_float(value, normalized));
}

// `elements` are all of the accessor.
template <class Number>
void copy_numbers(const StridedElements& elements, const Elements& range, int width, Number* out) {
    with_component(elements.component_type, [&](auto sample) {
        using T = decltype(sample);
        const auto copy = [&](const std::byte* from, Number* to) {
            for (int c = 0; c < width; ++c)
                to[c] = as_number<Number>(load<T>(from + std::size_t(c) * sizeof(T)),
                                          elements.normalized);
        };
        for_each_block(range.count, [&](std::size_t first, std::size_t last) {
            Number* to = out + first * std::size_t(width);
            if (range.chosen.empty()) {
                const std::byte* from = elements.data + (range.first + first) * elements.stride;
                for (std::size_t i = first; i < last; ++i, from += elements.stride, to += width)
                    copy(from, to);
            } else {
                for (std::size_t i = first; i < last; ++i, to += width)
                    copy(elements.data + range[i] * elements.stride, to);
            }
        });
    });
}

std::size_t element_size(const tinygltf::Accessor& accessor) {
    return std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(accessor.componentType))) *
           std::size_t(components(accessor));
}

const std::byte* view_data(const Document& document, int view, std::size_t offset,
                           const std::string& place) {
    const tinygltf::BufferView& slice = document.model.bufferViews[std::size_t(view)];
    const Bytes buffer = document.buffers[std::size_t(slice.buffer)];
    if (buffer.empty())
        throw Error(Failure::input, place,
                    fmt::format("buffer {} has no content: is the data compressed by an extension?",
                                slice.buffer));
    return buffer.data() + slice.byteOffset + offset;
}

// The elements of an accessor; no data: all zeros.
StridedElements elements_of(const Document& document, const tinygltf::Accessor& accessor,
                            const std::string& place) {
    StridedElements elements = {.component_type = accessor.componentType,
                                .normalized = accessor.normalized};
    if (accessor.bufferView < 0) return elements;
    const std::size_t given =
        document.model.bufferViews[std::size_t(accessor.bufferView)].byteStride;
    elements.stride = given != 0 ? given : element_size(accessor);
    elements.data = view_data(document, accessor.bufferView, accessor.byteOffset, place);
    return elements;
}

// glTF 2.0, section 3.6.2.3: calls `change(i, data)` for every element that a sparse accessor
// replaces.
template <class Change>
void for_each_sparse(const Document& document, const tinygltf::Accessor& accessor,
                     const std::string& place, Change&& change) {
    if (!accessor.sparse.isSparse) return;
    const auto& indices = accessor.sparse.indices;
    const auto& values = accessor.sparse.values;
    const std::byte* at =
        view_data(document, indices.bufferView, std::size_t(indices.byteOffset), place);
    const std::byte* value =
        view_data(document, values.bufferView, std::size_t(values.byteOffset), place);
    const std::size_t size = element_size(accessor);
    with_component(indices.componentType, [&](auto sample) {
        using T = decltype(sample);
        for (int i = 0; i < accessor.sparse.count; ++i, at += sizeof(T), value += size) {
            const auto index = std::size_t(load<T>(at));
            if (index >= accessor.count)
                throw Error(Failure::input, place + "/sparse",
                            fmt::format("index {} is {}, but there are {} elements", i, index,
                                        accessor.count));
            change(index, value);
        }
    });
}

// Where element `number` of an accessor is in a range; range.count: not in it.
std::size_t place_in(const Elements& range, std::size_t number) {
    if (range.chosen.empty())
        return number < range.first ? range.count : std::min(number - range.first, range.count);
    const auto found = std::ranges::lower_bound(range.chosen, number);
    const bool is_in = found != range.chosen.end() && *found == number;
    return is_in ? std::size_t(found - range.chosen.begin()) : range.count;
}

template <class Number>
void read_numbers(const Document& document, int index, const Elements& range, int width,
                  Number* out) {
    const tinygltf::Accessor& accessor = document.model.accessors[std::size_t(index)];
    const std::string place = document.place(fmt::format("/accessors/{}", index));
    StridedElements elements = elements_of(document, accessor, place);
    const std::size_t numbers = range.count * std::size_t(width);
    if (elements.data == nullptr)
        std::fill_n(out, numbers, Number(0));
    else
        copy_numbers(elements, range, width, out);

    for_each_sparse(document, accessor, place, [&](std::size_t i, const std::byte* value) {
        const std::size_t at = place_in(range, i);
        if (at == range.count) return;
        elements.data = value;
        copy_numbers(elements, {.count = 1}, width, out + at * std::size_t(width));
    });
}

template <class Number>
void check_finite(const Document& document, int accessor, const Elements& range, int width,
                  const Number* numbers) {
    const Number* const end = numbers + range.count * std::size_t(width);
    const Number* const bad =
        std::find_if_not(numbers, end, [](Number n) { return std::isfinite(n); });
    if (bad != end)
        throw Error(Failure::input, document.place(fmt::format("/accessors/{}", accessor)),
                    fmt::format("element {} is not a finite number",
                                range[std::size_t(bad - numbers) / std::size_t(width)]));
}

}  // namespace

int components(const tinygltf::Accessor& accessor) {
    return tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type));
}

void read_any_floats(const Document& document, int accessor, const Elements& range, int width,
                     float* out) {
    read_numbers(document, accessor, range, width, out);
}

void read_floats(const Document& document, int accessor, const Elements& range, int width,
                 float* out) {
    read_numbers(document, accessor, range, width, out);
    check_finite(document, accessor, range, width, out);
}

void read_doubles(const Document& document, int accessor, const Elements& range, int width,
                  double* out) {
    read_numbers(document, accessor, range, width, out);
    check_finite(document, accessor, range, width, out);
}

void read_indices(const Document& document, int index, Index* out) {
    const tinygltf::Accessor& accessor = document.model.accessors[std::size_t(index)];
    const std::string place = document.place(fmt::format("/accessors/{}", index));
    const StridedElements elements = elements_of(document, accessor, place);
    with_component(accessor.componentType, [&](auto sample) {
        using T = decltype(sample);
        const std::byte* from = elements.data;
        for (std::size_t i = 0; i < accessor.count; ++i, from += elements.stride)
            out[i] = from == nullptr ? 0 : Index(load<T>(from));
        for_each_sparse(document, accessor, place, [&](std::size_t i, const std::byte* value) {
            out[i] = Index(load<T>(value));
        });
    });
}

}  // namespace penumbra::gltf
