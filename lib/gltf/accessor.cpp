#include "tandem/gltf/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "tandem/gltf/structure.h"

namespace tandem::gltf {

namespace {

/// Elements that an accessor without a buffer view may have: they cost the file nothing, but memory here.
constexpr std::size_t most_zeros = std::size_t{1} << 24;

template <class Integer>
float normalised(const unsigned char* bytes) {
    Integer value;
    std::memcpy(&value, bytes, sizeof(value));
    const float largest = std::numeric_limits<Integer>::max();
    return std::max(static_cast<float>(value) / largest, -1.0F);
}

float component_at(const unsigned char* bytes, int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return normalised<std::int8_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return normalised<std::uint8_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return normalised<std::int16_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return normalised<std::uint16_t>(bytes);
        default: {
            float value = 0;
            std::memcpy(&value, bytes, sizeof(value));
            return value;
        }
    }
}

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

    std::vector<float> run() {
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
        check_finite();
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
        if (accessor_.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) return;
        if (need_.normalised && accessor_.normalized && component_ < 4) return;
        fail(fmt::format("has components of type {}{}, but {} ({}) needs floats (5126){}", accessor_.componentType,
                         accessor_.normalized ? ", normalised" : "", need_.for_what, need_.used_at,
                         need_.normalised ? " or normalised bytes or shorts" : ""));
    }

    /// check_structure() has made sure that all of it lies in the buffer.
    View view(int index, std::size_t offset, std::size_t element) const {
        const tinygltf::BufferView& view = source_.model.bufferViews[static_cast<std::size_t>(index)];
        const auto& data = source_.model.buffers[static_cast<std::size_t>(view.buffer)].data;
        return {data.data() + view.byteOffset + offset, view.byteStride == 0 ? element : view.byteStride};
    }

    void read_element(const unsigned char* bytes, std::size_t element) {
        for (std::size_t c = 0; c < width_; ++c) {
            values_[element * width_ + c] = component_at(bytes + c * component_, accessor_.componentType);
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
    const AccessorNeed& need_;
    const tinygltf::Accessor& accessor_;
    const Json& json_;
    std::string path_;
    std::size_t width_;
    std::size_t component_;
    std::vector<float> values_;
};

}  // namespace

std::vector<float> read_accessor(const Source& source, std::size_t index, const AccessorNeed& need) {
    return Reader(source, index, need).run();
}

}  // namespace tandem::gltf
