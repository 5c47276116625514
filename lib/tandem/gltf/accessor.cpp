#include "tandem/gltf/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "tandem/base/large_array.h"
#include "tandem/base/parallel.h"
#include "tandem/gltf/structure.h"

namespace tandem::gltf {

namespace {

/// Limit of elements of an accessor without a buffer view: they cost the file nothing, but memory here.
constexpr std::size_t most_zeros = std::size_t{1} << 24;

constexpr std::size_t elements_at_once = 1U << 16;

/// glTF 2.0, 3.6.2.2.
enum ComponentType : std::uint64_t {
    signed_byte = 5120,
    unsigned_byte = 5121,
    signed_short = 5122,
    unsigned_short = 5123,
    unsigned_int = 5125,
    float_number = 5126
};

template <class Number>
Number number_at(const std::byte* bytes) {
    Number value;
    std::memcpy(&value, bytes, sizeof(value));
    return value;
}

template <class Integer>
float float_at(const std::byte* bytes, bool normalised) {
    const auto value = static_cast<float>(number_at<Integer>(bytes));
    const float largest = std::numeric_limits<Integer>::max();
    return normalised ? std::max(value / largest, -1.0F) : value;
}

void decode(const std::byte* bytes, std::uint64_t component_type, bool normalised, float& value) {
    switch (component_type) {
        case signed_byte:
            value = float_at<std::int8_t>(bytes, normalised);
            return;
        case unsigned_byte:
            value = float_at<std::uint8_t>(bytes, normalised);
            return;
        case signed_short:
            value = float_at<std::int16_t>(bytes, normalised);
            return;
        case unsigned_short:
            value = float_at<std::uint16_t>(bytes, normalised);
            return;
        default:
            value = number_at<float>(bytes);
    }
}

void decode(const std::byte* bytes, std::uint64_t component_type, bool, std::uint32_t& value) {
    switch (component_type) {
        case unsigned_byte:
            value = number_at<std::uint8_t>(bytes);
            return;
        case unsigned_short:
            value = number_at<std::uint16_t>(bytes);
            return;
        default:
            value = number_at<std::uint32_t>(bytes);
    }
}

bool are_of(Components components, std::uint64_t component_type, bool normalised) {
    const bool is_float = component_type == float_number;
    const bool is_small = component_bytes(component_type) < 4;
    switch (components) {
        case Components::floats:
            return is_float;
        case Components::normalised:
            return is_float || (is_small && normalised);
        case Components::quantised:
            return is_float || is_small;
        case Components::indices:
            break;
    }
    return component_type == unsigned_byte || component_type == unsigned_short || component_type == unsigned_int;
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
            return "unsigned integers (5121, 5123 or 5125)";
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
          json_(source.document.json["accessors"][index]),
          path_(fmt::format("accessors[{}]", index)),
          count_(json_["count"].get<std::size_t>()),
          component_type_(json_["componentType"].get<std::uint64_t>()),
          normalised_(json_.value("normalized", false)),
          width_(component_count(need.type)),
          component_(component_bytes(component_type_)) {}

    std::vector<Value> run() {
        check_type();
        const Json* viewed = find(json_, "bufferView");
        if (viewed == nullptr && count_ > most_zeros) {
            fail(fmt::format("has {} elements but no buffer view; add one", count_));
        }
        const Json* sparse = find(json_, "sparse");
        const bool reads_all = need_.elements == nullptr || sparse != nullptr;
        const std::size_t count = reads_all ? count_ : need_.elements->size();
        make_large(values_, count * width_, count * width_);
        if (viewed != nullptr) {
            const View from = view(json_, component_ * width_);
            for_each_chunk(count, elements_at_once, [&](const Chunk& chunk) {
                for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
                    read_element(from.bytes + (reads_all ? i : (*need_.elements)[i]) * from.stride, i);
                }
            });
        }
        if (sparse != nullptr) {
            replace(*sparse);
            if (need_.elements != nullptr) keep(*need_.elements);
        }
        if constexpr (std::is_floating_point_v<Value>) {
            if (need_.is_finite) check_finite();
        }
        return std::move(values_);
    }

  private:
    struct View {
        const std::byte* bytes;
        std::size_t stride;
    };

    [[noreturn]] void fail(const std::string& what) const { source_.document.fail(path_, what); }

    void check_type() const {
        const auto type = json_["type"].get<std::string>();
        if (type != need_.type) {
            fail(fmt::format("is of type {}, but {} ({}) needs {}", type, need_.for_what, need_.used_at, need_.type));
        }
        if (are_of(need_.components, component_type_, normalised_)) return;
        fail(fmt::format("has components of type {}{}, but {} ({}) needs {}", component_type_,
                         normalised_ ? ", normalised" : "", need_.for_what, need_.used_at, words(need_.components)));
    }

    /// The bytes of an object with a bufferView; check_schema() has made sure that they are in the buffer.
    View view(const Json& object, std::size_t element) const {
        const Json& view = source_.document.json["bufferViews"][object["bufferView"].get<std::size_t>()];
        const std::size_t offset =
            view.value("byteOffset", std::size_t{0}) + object.value("byteOffset", std::size_t{0});
        return {source_.buffers[view["buffer"].get<std::size_t>()].data() + offset, view.value("byteStride", element)};
    }

    void read_element(const std::byte* bytes, std::size_t element) {
        for (std::size_t c = 0; c < width_; ++c) {
            decode(bytes + c * component_, component_type_, normalised_, values_[element * width_ + c]);
        }
    }

    void replace(const Json& sparse) {
        const Json& indices = sparse["indices"];
        const Json& values = sparse["values"];
        const std::size_t index_bytes = component_bytes(indices["componentType"].get<std::uint64_t>());
        const View index_view = view(indices, index_bytes);
        const View value_view = view(values, component_ * width_);
        const auto count = sparse["count"].get<std::size_t>();
        for (std::size_t i = 0; i < count; ++i) {
            std::uint32_t at = 0;  // little endian: the lower bytes come first
            std::memcpy(&at, index_view.bytes + i * index_view.stride, index_bytes);
            if (at >= count_) {
                source_.document.fail(path_ + ".sparse.indices", fmt::format("entry {} is {}, but the accessor has {} "
                                                                             "elements",
                                                                             i, at, count_));
            }
            read_element(value_view.bytes + i * value_view.stride, at);
        }
    }

    void keep(const std::vector<std::uint32_t>& elements) {
        std::vector<Value> kept;
        kept.reserve(elements.size() * width_);
        for (const std::uint32_t element : elements) {
            const auto first = values_.begin() + static_cast<std::ptrdiff_t>(element * width_);
            kept.insert(kept.end(), first, first + static_cast<std::ptrdiff_t>(width_));
        }
        values_ = std::move(kept);
    }

    void check_finite() const {
        for_each_chunk(values_.size(), elements_at_once, [&](const Chunk& chunk) {
            for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
                if (std::isfinite(values_[i])) continue;
                fail(fmt::format("element {} has a number that is not finite; export the file again", i / width_));
            }
        });
    }

    const Source& source_;
    const AccessorNeed need_;
    const Json& json_;
    std::string path_;
    std::size_t count_;
    std::uint64_t component_type_;
    bool normalised_;
    std::size_t width_;
    std::size_t component_;
    std::vector<Value> values_;
};

}  // namespace

std::size_t element_count(const Source& source, std::size_t index) {
    return source.document.json["accessors"][index]["count"].get<std::size_t>();
}

bool has_components(const Source& source, std::size_t index, Components components) {
    const Json& accessor = source.document.json["accessors"][index];
    return are_of(components, accessor["componentType"].get<std::uint64_t>(), accessor.value("normalized", false));
}

std::uint32_t largest_index(const Source& source, std::size_t index) {
    const auto type = source.document.json["accessors"][index]["componentType"].get<std::uint64_t>();
    return type == unsigned_byte ? 0xFF : type == unsigned_short ? 0xFFFF : 0xFFFFFFFF;
}

std::vector<float> read_accessor(const Source& source, std::size_t index, const AccessorNeed& need) {
    return Reader<float>(source, index, need).run();
}

std::vector<std::uint32_t> read_indices(const Source& source, std::size_t index, const std::string& used_at) {
    return Reader<std::uint32_t>(source, index, {"SCALAR", Components::indices, "the indices of a mesh", used_at})
        .run();
}

}  // namespace tandem::gltf
