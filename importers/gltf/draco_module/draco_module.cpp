// The Draco module: everything that penumbra asks of libdraco, behind DracoModule.
#include "importers/gltf/draco_module/draco_module.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>

namespace penumbra {
namespace {

// What the data begin with, read before anything is allocated for it: see the bitstream
// specification of Draco 2.2. Behind the end there are zeros.
struct Beginning {
    std::span<const std::byte> data;
    std::size_t at = 0;

    std::uint64_t byte() { return at < data.size() ? std::uint64_t(data[at++]) : 0; }
    std::uint64_t varint() {
        std::uint64_t value = 0;
        for (int shift = 0; at < data.size() && shift < 64; shift += 7) {
            const std::uint64_t part = byte();
            value |= (part & 0x7f) << shift;
            if (part < 0x80) break;
        }
        return value;
    }
    void skip(std::uint64_t count) {
        at =
            count < data.size() - std::min(at, data.size()) ? at + std::size_t(count) : data.size();
    }
    bool ended() const { return at >= data.size(); }

    // Section "Metadata": names and values, then metadata with names of their own.
    void skip_metadata() {
        std::uint64_t open = 1;
        for (bool first = true; open > 0 && !ended(); first = false, --open) {
            if (!first) skip(byte());
            for (std::uint64_t entries = varint(); entries > 0 && !ended(); --entries) {
                skip(byte());
                skip(varint());
            }
            open += varint();
        }
    }
};

// Sections "Header", "Sequential Connectivity" and "EdgeBreaker Connectivity".
std::uint64_t declared_facets(std::span<const std::byte> data) {
    constexpr std::size_t header = 11;
    constexpr auto metadata = std::byte(0x80), edge_breaker = std::byte(1);
    if (data.size() < header) return 0;
    Beginning rest = {data, header};
    if ((data[10] & metadata) != std::byte(0)) {
        for (std::uint64_t attributes = rest.varint(); attributes > 0 && !rest.ended();
             --attributes) {
            rest.varint();  // its id
            rest.skip_metadata();
        }
        rest.skip_metadata();
    }
    if (data[8] == edge_breaker) {
        rest.byte();    // how it was traversed
        rest.varint();  // number of vertices
    }
    return rest.varint();
}

// Of a byte. The codec gets a facet to less than a bit only where it repeats; a small file should
// not be able to ask for much memory.
constexpr std::size_t most_facets = 4096;

std::uint64_t plausible_facets(std::span<const std::byte> data) {
    const std::uint64_t facets = declared_facets(data);
    return facets > data.size() * most_facets ? 0 : facets;
}

// The values of all points as numbers of type T.
template <class T>
bool copy_values(const draco::PointAttribute& attribute, std::uint32_t points, std::size_t width,
                 std::vector<std::byte>& bytes) {
    std::vector<T> one(width);
    const std::size_t size = width * sizeof(T);
    bytes.resize(points * size);
    for (std::uint32_t p = 0; p < points; ++p) {
        const auto index = attribute.mapped_index(draco::PointIndex(p));
        if (index.value() >= attribute.size() ||
            !attribute.ConvertValue<T>(index, std::int8_t(width), one.data()))
            return false;
        std::memcpy(bytes.data() + p * size, one.data(), size);
    }
    return true;
}

bool copy_attribute(const draco::PointAttribute& attribute, std::uint32_t points,
                    const DracoWish& wish, std::vector<std::byte>& bytes) {
    const auto width = std::size_t(wish.width);
    switch (wish.number) {
    case DracoNumber::i8: return copy_values<std::int8_t>(attribute, points, width, bytes);
    case DracoNumber::u8: return copy_values<std::uint8_t>(attribute, points, width, bytes);
    case DracoNumber::i16: return copy_values<std::int16_t>(attribute, points, width, bytes);
    case DracoNumber::u16: return copy_values<std::uint16_t>(attribute, points, width, bytes);
    case DracoNumber::u32: return copy_values<std::uint32_t>(attribute, points, width, bytes);
    case DracoNumber::f32: return copy_values<float>(attribute, points, width, bytes);
    }
    return false;
}

std::vector<std::byte> copy_indices(const draco::Mesh& mesh) {
    std::vector<std::byte> bytes(std::size_t(mesh.num_faces()) * 12);
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
        const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t point = face[i].value();
            std::memcpy(bytes.data() + 12 * std::size_t(f) + 4 * i, &point, 4);
        }
    }
    return bytes;
}

DracoMesh failed(std::string problem) {
    DracoMesh none;
    while (!problem.empty() && problem.back() == '.') problem.pop_back();
    none.problem = std::move(problem);
    return none;
}

DracoMesh decode_mesh(std::span<const std::byte> data, std::span<const DracoWish> wishes) {
    if (const std::uint64_t facets = declared_facets(data); facets > data.size() * most_facets)
        return failed("it claims " + std::to_string(facets) + " facets in " +
                      std::to_string(data.size()) + " bytes");

    draco::DecoderBuffer source;
    source.Init(reinterpret_cast<const char*>(data.data()), data.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&source);
    if (!decoded.ok()) return failed(decoded.status().error_msg_string());
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();

    DracoMesh result = {.indices = copy_indices(*mesh),
                        .facets = mesh->num_faces(),
                        .vertices = mesh->num_points()};
    for (const DracoWish& wish : wishes) {
        const std::string name = "attribute " + std::to_string(wish.id);
        const draco::PointAttribute* const attribute = mesh->GetAttributeByUniqueId(wish.id);
        if (attribute == nullptr) return failed("there is no " + name);
        if (int(attribute->num_components()) != wish.width)
            return failed(name + " has " + std::to_string(int(attribute->num_components())) +
                          " numbers a vertex instead of " + std::to_string(wish.width));
        if (!copy_attribute(*attribute, mesh->num_points(), wish, result.attributes.emplace_back()))
            return failed(name + " does not fit its accessor");
    }
    return result;
}

DracoMesh decode(std::span<const std::byte> data, std::span<const DracoWish> wishes) {
    try {
        return decode_mesh(data, wishes);
    } catch (const std::bad_alloc&) {
        return failed("not enough memory");
    } catch (const std::exception& error) {
        return failed(error.what());
    }
}

}  // namespace
}  // namespace penumbra

extern "C" __attribute__((visibility("default"))) const void* penumbra_draco_module() {
    static const penumbra::DracoModule module = {penumbra::draco_module_abi, penumbra::decode,
                                                 penumbra::plausible_facets};
    return &module;
}
