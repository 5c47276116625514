#include "tandem/gltf/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "tandem/gltf/structure.h"

namespace tandem::gltf {

namespace {

/// Elements that an accessor without a buffer view may have: they cost the file nothing, but memory here.
constexpr std::size_t most_zeros = std::size_t{1} << 24;

template <class Number>
Number number_at(const unsigned char* bytes) {
    Number value;
    std::memcpy(&value, bytes, sizeof(value));
    return value;
}

template <class Integer>
float float_at(const unsigned char* bytes, bool normalised) {
    const auto value = static_cast<float>(number_at<Integer>(bytes));
    const float largest = std::numeric_limits<Integer>::max();
    return normalised ? std::max(value / largest, -1.0F) : value;
}

void decode(const unsigned char* bytes, int component_type, bool normalised, float& value) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            value = float_at<std::int8_t>(bytes, normalised);
            return;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            value = float_at<std::uint8_t>(bytes, normalised);
            return;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            value = float_at<std::int16_t>(bytes, normalised);
            return;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            value = float_at<std::uint16_t>(bytes, normalised);
            return;
        default:
            value = number_at<float>(bytes);
    }
}

void decode(const unsigned char* bytes, int component_type, bool, std::uint32_t& value) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            value = number_at<std::uint8_t>(bytes);
            return;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            value = number_at<std::uint16_t>(bytes);
            return;
        default:
            value = number_at<std::uint32_t>(bytes);
    }
}

const char* words(Components components) {
    switch (components) {
        case Components::floats:
            return "floats (5126)";
        case Components::normalised:
            return "floats (5126) or normalised bytes or shorts";
        case Components::quantised:
            return "floats (5126), bytes or shorts";
        case Components::indices:
            return "unsigned integers (5121, 5123 or 5125), not normalised";
    }
    return "others";
}

/// Reads elements as floats or as indices.
template <class Value>
class Reader {
  public:
    Reader(const Source& source, std::size_t index, const AccessorNeed& need)
        : source_(source),
          need_(need),
          accessor_(source.model.accessors[index]),
          json_(source.document.json["accessors"][index]),
          path_(fmt::format("accessors[{}]", index)),
          width_(component_count(need.type)),
          component_(component_bytes(static_cast<std::uint64_t>(accessor_.componentType))) {}

    std::vector<Value> run() {
        check_type();
        const bool zeros = accessor_.bufferView < 0;
        if (zeros && accessor_.count > most_zeros) {
            fail(fmt::format("has {} elements and no buffer view to hold them; give it one", accessor_.count));
        }
        values_.resize(accessor_.count * width_);
        if (!zeros) {
            const View from = view(accessor_.bufferView, accessor_.byteOffset, component_ * width_);
            for (std::size_t i = 0; i < accessor_.count; ++i) read_element(from.bytes + i * from.stride, i);
        }
        if (const Json* sparse = find(json_, "sparse")) replace(*sparse);
        if constexpr (std::is_floating_point_v<Value>) check_finite();
        return std::move(values_);
    }

  private:
    struct View {
        const unsigned char* bytes;
        std::size_t stride;
    };

    [[noreturn]] void fail(const std::string& what) const { source_.document.fail(path_, what); }

    void check_type() const {
        const auto type = json_["type"].get<std::string>();
        if (type != need_.type) {
            fail(fmt::format("is of type {}, but {} ({}) needs {}", type, need_.for_what, need_.used_at, need_.type));
        }
        if (accepts_component()) return;
        fail(fmt::format("has components of type {}{}, but {} ({}) needs {}", accessor_.componentType,
                         accessor_.normalized ? ", normalised" : "", need_.for_what, need_.used_at,
                         words(need_.components)));
    }

    bool accepts_component() const {
        const bool is_float = accessor_.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
        const bool is_small = component_ < 4;
        switch (need_.components) {
            case Components::floats:
                return is_float;
            case Components::normalised:
                return is_float || (is_small && accessor_.normalized);
            case Components::quantised:
                return is_float || is_small;
            case Components::indices:
                break;
        }
        return !accessor_.normalized && (accessor_.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                         accessor_.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                                         accessor_.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
    }

    /// check_structure() has made sure that all of it lies in the buffer.
    View view(int index, std::size_t offset, std::size_t element) const {
        const tinygltf::BufferView& view = source_.model.bufferViews[static_cast<std::size_t>(index)];
        const auto& data = source_.model.buffers[static_cast<std::size_t>(view.buffer)].data;
        return {data.data() + view.byteOffset + offset, view.byteStride == 0 ? element : view.byteStride};
    }

    void read_element(const unsigned char* bytes, std::size_t element) {
        for (std::size_t c = 0; c < width_; ++c) {
            decode(bytes + c * component_, accessor_.componentType, accessor_.normalized,
                   values_[element * width_ + c]);
        }
    }

    void replace(const Json& sparse) {
        const Json& indices = sparse["indices"];
        const Json& values = sparse["values"];
        const std::size_t index_bytes = component_bytes(indices["componentType"].get<std::uint64_t>());
        const View index_view =
            view(indices["bufferView"].get<int>(), indices.value("byteOffset", std::size_t{0}), index_bytes);
        const View value_view =
            view(values["bufferView"].get<int>(), values.value("byteOffset", std::size_t{0}), component_ * width_);
        const auto count = sparse["count"].get<std::size_t>();
        for (std::size_t i = 0; i < count; ++i) {
            std::uint32_t at = 0;  // little endian: the lower bytes come first
            std::memcpy(&at, index_view.bytes + i * index_view.stride, index_bytes);
            if (at >= accessor_.count) {
                source_.document.fail(path_ + ".sparse.indices", fmt::format("entry {} is {}, but the accessor has {} "
                                                                             "elements",
                                                                             i, at, accessor_.count));
            }
            read_element(value_view.bytes + i * value_view.stride, at);
        }
    }

    void check_finite() const {
        const auto bad = std::find_if_not(values_.begin(), values_.end(), [](float v) { return std::isfinite(v); });
        if (bad == values_.end()) return;
        fail(fmt::format("element {} holds a number that is not finite; export the file anew",
                         static_cast<std::size_t>(bad - values_.begin()) / width_));
    }

    const Source& source_;
    const AccessorNeed need_;
    const tinygltf::Accessor& accessor_;
    const Json& json_;
    std::string path_;
    std::size_t width_;
    std::size_t component_;
    std::vector<Value> values_;
};

}  // namespace

std::vector<float> read_accessor(const Source& source, std::size_t index, const AccessorNeed& need) {
    return Reader<float>(source, index, need).run();
}

std::vector<std::uint32_t> read_indices(const Source& source, std::size_t index, const std::string& used_at) {
    return Reader<std::uint32_t>(source, index, {"SCALAR", Components::indices, "the indices of a mesh", used_at})
        .run();
}

}  // namespace tandem::gltf
