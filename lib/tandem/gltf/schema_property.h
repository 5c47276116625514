/// One property of a glTF object: its JSON type, its range, and the treatment of invalid values.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace tandem::gltf::schema {

enum class Kind { object, objects, index, indices, index_map, index_maps, whole, number, numbers, text, texts, truth };
enum class Presence { optional, required };

/// The treatment of an invalid value.
enum class Care {
    lenient,  ///< the property is left out
    strict,   ///< the object with the property is left out
    vital,    ///< the file is refused: the image would be another one
};

inline constexpr double infinity = std::numeric_limits<double>::infinity();
/// The largest float: the limit of numbers that Tandem stores as floats.
inline constexpr double largest = 3.4028234663852886e38;
inline constexpr double most_whole = 9007199254740992;  // 2^53
inline constexpr double smallest = std::numeric_limits<double>::min();

/// One property of one object.
struct Property {
    const char* owner;  ///< kind of object, as named in this table
    const char* name;
    Kind kind;
    const char* argument = "";  ///< object(s): their kind; index: the array; whole, text: the choices, if limited
    double low = -infinity;     ///< number(s): closed range
    double high = infinity;
    std::size_t count = 0;  ///< numbers: how many; 0 for any number of them
    Presence presence = Presence::optional;
    Care care = Care::lenient;
    bool is_clamped = false;  ///< number(s): finite values are clamped to the range
    double usual = infinity;  ///< number(s): glTF's limit, if Tandem allows more

    constexpr Property required() const {
        Property copy = with(Care::strict);
        copy.presence = Presence::required;
        return copy;
    }
    constexpr Property with(Care how) const {
        Property copy = *this;
        copy.care = how;
        return copy;
    }
    constexpr Property clamped() const {
        Property copy = *this;
        copy.is_clamped = true;
        return copy;
    }
    constexpr Property usually_up_to(double limit) const {
        Property copy = *this;
        copy.usual = limit;
        return copy;
    }
    constexpr Property between(double from, double to) const {
        Property copy = *this;
        copy.low = from;
        copy.high = to;
        return copy;
    }
    constexpr Property positive() const { return between(smallest, largest); }
    constexpr Property not_negative() const { return between(0, largest); }
};

constexpr Property object(const char* owner, const char* name, const char* kind) {
    return {owner, name, Kind::object, kind};
}
constexpr Property objects(const char* owner, const char* name, const char* kind) {
    return {owner, name, Kind::objects, kind};
}
constexpr Property index(const char* owner, const char* name, const char* array) {
    return {owner, name, Kind::index, array};
}
constexpr Property indices(const char* owner, const char* name, const char* array) {
    return {owner, name, Kind::indices, array};
}
constexpr Property index_map(const char* owner, const char* name, const char* array) {
    return {owner, name, Kind::index_map, array};
}
constexpr Property index_maps(const char* owner, const char* name, const char* array) {
    return {owner, name, Kind::index_maps, array};
}
/// A whole number of 0 or more, below 2^53; or one of `choices`, separated by spaces.
constexpr Property whole(const char* owner, const char* name, const char* choices = "") {
    return {owner, name, Kind::whole, choices, 0, most_whole};
}
constexpr Property number(const char* owner, const char* name) {
    return {owner, name, Kind::number, "", -largest, largest};
}
constexpr Property numbers(const char* owner, const char* name, std::size_t count) {
    return {owner, name, Kind::numbers, "", -largest, largest, count};
}
constexpr Property text(const char* owner, const char* name, const char* choices = "") {
    return {owner, name, Kind::text, choices};
}
constexpr Property texts(const char* owner, const char* name) { return {owner, name, Kind::texts}; }
constexpr Property truth(const char* owner, const char* name) { return {owner, name, Kind::truth}; }

/// All properties that Tandem reads. The arrays of the root are ordered so that elements precede the references to
/// them.
[[nodiscard]] std::span<const Property> all_properties();

}  // namespace tandem::gltf::schema
