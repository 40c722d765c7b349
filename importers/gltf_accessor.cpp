// Accessors -> numbers.
#include "gltf.h"
#include "parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace penumbra::gltf {
namespace {

// Elements of one type at a regular distance in a buffer.
struct Elements {
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
    if constexpr (std::is_floating_point_v<T>) return value;
    if (!normalized) return float(value);
    const float fraction = float(double(value) / double(std::numeric_limits<T>::max()));
    return std::max(fraction, -1.0F);
}

// Calls `work` with a value of the component's C++ type.
template <class Work>
void with_component(int type, Work&& work) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return work(std::int8_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return work(std::uint8_t());
    case TINYGLTF_COMPONENT_TYPE_SHORT: return work(std::int16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return work(std::uint16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return work(std::uint32_t());
    default: return work(float());
    }
}

// `elements` are all of the accessor.
void copy_floats(const Elements& elements, const Range& range, int width, float* out) {
    with_component(elements.component_type, [&](auto sample) {
        using T = decltype(sample);
        const auto copy = [&](const std::byte* from, float* to) {
            for (int c = 0; c < width; ++c)
                to[c] = as_float(load<T>(from + std::size_t(c) * sizeof(T)), elements.normalized);
        };
        for_each_block(range.count, [&](std::size_t first, std::size_t last) {
            float* to = out + first * std::size_t(width);
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
Elements elements_of(const Document& document, const tinygltf::Accessor& accessor,
                     const std::string& place) {
    Elements elements = {.component_type = accessor.componentType,
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
std::size_t place_in(const Range& range, std::size_t number) {
    if (range.chosen.empty())
        return number < range.first ? range.count : std::min(number - range.first, range.count);
    const auto found = std::ranges::lower_bound(range.chosen, number);
    const bool is_in = found != range.chosen.end() && *found == number;
    return is_in ? std::size_t(found - range.chosen.begin()) : range.count;
}

}  // namespace

int components(const tinygltf::Accessor& accessor) {
    return tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type));
}

void read_floats(const Document& document, int index, const Range& range, int width, float* out) {
    const tinygltf::Accessor& accessor = document.model.accessors[std::size_t(index)];
    const std::string place = document.place(fmt::format("/accessors/{}", index));
    Elements elements = elements_of(document, accessor, place);
    const std::size_t numbers = range.count * std::size_t(width);
    if (elements.data == nullptr)
        std::fill_n(out, numbers, 0.0F);
    else
        copy_floats(elements, range, width, out);

    for_each_sparse(document, accessor, place, [&](std::size_t i, const std::byte* value) {
        const std::size_t at = place_in(range, i);
        if (at == range.count) return;
        elements.data = value;
        copy_floats(elements, {.count = 1}, width, out + at * std::size_t(width));
    });

    const float* bad =
        std::find_if_not(out, out + numbers, [](float f) { return std::isfinite(f); });
    if (bad != out + numbers)
        throw Error(Failure::input, place,
                    fmt::format("element {} is not a finite number",
                                range[std::size_t(bad - out) / std::size_t(width)]));
}

void read_indices(const Document& document, int index, Index* out) {
    const tinygltf::Accessor& accessor = document.model.accessors[std::size_t(index)];
    const std::string place = document.place(fmt::format("/accessors/{}", index));
    const Elements elements = elements_of(document, accessor, place);
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
