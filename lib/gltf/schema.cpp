#include "tandem/gltf/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "tandem/film/display.h"

namespace tandem::gltf {

namespace {

enum class Kind { object, objects, index, indices, index_map, index_maps, whole, number, numbers, text, texts, truth };
enum class Presence { optional, required };

constexpr double infinity = std::numeric_limits<double>::infinity();
/// The largest float: a number that Tandem keeps as a float must not overflow there.
constexpr double largest = 3.4028234663852886e38;
constexpr double smallest = std::numeric_limits<double>::min();

/// One property of one object.
struct Property {
    const char* owner;  ///< kind of object, a name of this table
    const char* name;
    Kind kind;
    const char* argument = "";  ///< object(s): their kind; index: the array; whole, text: the choices, if limited
    double low = -infinity;     ///< number(s): closed range
    double high = infinity;
    std::size_t count = 0;  ///< numbers: how many; 0 for any number of them
    Presence presence = Presence::optional;

    constexpr Property required() const {
        Property copy = *this;
        copy.presence = Presence::required;
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
/// A whole number of 0 or more, below 2^53; or one of `choices`, between spaces.
constexpr Property whole(const char* owner, const char* name, const char* choices = "") {
    return {owner, name, Kind::whole, choices, 0, 9007199254740992.0};
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

constexpr const char* lights_array = "extensions/KHR_lights_punctual/lights";
constexpr const char* shapes_array = "extensions/KHR_implicit_shapes/shapes";

/// glTF 2.0, section 5, and the extensions that Tandem reads. Every object may also have `extensions` and, except
/// the ones inside of extensions, a `name`.
constexpr Property properties[] = {
    object("root", "asset", "asset").required(),
    texts("root", "extensionsUsed"),
    texts("root", "extensionsRequired"),
    objects("root", "accessors", "accessor"),
    objects("root", "animations", "animation"),
    objects("root", "buffers", "buffer"),
    objects("root", "bufferViews", "buffer view"),
    objects("root", "cameras", "camera"),
    objects("root", "images", "image"),
    objects("root", "materials", "material"),
    objects("root", "meshes", "mesh"),
    objects("root", "nodes", "node"),
    objects("root", "samplers", "sampler"),
    index("root", "scene", "scenes"),
    objects("root", "scenes", "scene"),
    objects("root", "skins", "skin"),
    objects("root", "textures", "texture"),

    text("asset", "version").required(),
    text("asset", "minVersion"),

    text("accessor", "name"),
    index("accessor", "bufferView", "bufferViews"),
    whole("accessor", "byteOffset"),
    whole("accessor", "componentType", "5120 5121 5122 5123 5125 5126").required(),
    truth("accessor", "normalized"),
    whole("accessor", "count").between(1, 9007199254740992.0).required(),
    text("accessor", "type", "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4").required(),
    numbers("accessor", "max", 0),
    numbers("accessor", "min", 0),
    object("accessor", "sparse", "sparse"),
    whole("sparse", "count").between(1, 9007199254740992.0).required(),
    object("sparse", "indices", "sparse indices").required(),
    object("sparse", "values", "sparse values").required(),
    index("sparse indices", "bufferView", "bufferViews").required(),
    whole("sparse indices", "byteOffset"),
    whole("sparse indices", "componentType", "5121 5123 5125").required(),
    index("sparse values", "bufferView", "bufferViews").required(),
    whole("sparse values", "byteOffset"),

    text("animation", "name"),
    objects("animation", "channels", "channel").required(),
    objects("animation", "samplers", "animation sampler").required(),
    whole("channel", "sampler").required(),
    object("channel", "target", "target").required(),
    index("target", "node", "nodes"),
    text("target", "path").required(),
    index("animation sampler", "input", "accessors").required(),
    text("animation sampler", "interpolation", "LINEAR STEP CUBICSPLINE"),
    index("animation sampler", "output", "accessors").required(),

    text("buffer", "name"),
    text("buffer", "uri"),
    whole("buffer", "byteLength").between(1, 9007199254740992.0).required(),

    text("buffer view", "name"),
    index("buffer view", "buffer", "buffers").required(),
    whole("buffer view", "byteOffset"),
    whole("buffer view", "byteLength").between(1, 9007199254740992.0).required(),
    whole("buffer view", "byteStride").between(4, 252),
    whole("buffer view", "target", "34962 34963"),

    text("camera", "name"),
    text("camera", "type", "perspective orthographic").required(),
    object("camera", "perspective", "perspective"),
    object("camera", "orthographic", "orthographic"),
    number("perspective", "aspectRatio").positive(),
    number("perspective", "yfov").between(smallest, 3.14159).required(),
    number("perspective", "zfar").positive(),
    number("perspective", "znear").positive().required(),
    number("orthographic", "xmag").required(),
    number("orthographic", "ymag").positive().required(),
    number("orthographic", "zfar").required(),
    number("orthographic", "znear").required(),

    text("image", "name"),
    text("image", "uri"),
    text("image", "mimeType"),
    index("image", "bufferView", "bufferViews"),

    text("material", "name"),
    object("material", "pbrMetallicRoughness", "pbr"),
    object("material", "normalTexture", "texture info"),
    object("material", "occlusionTexture", "texture info"),
    object("material", "emissiveTexture", "texture info"),
    numbers("material", "emissiveFactor", 3).between(0, 1),
    text("material", "alphaMode", "OPAQUE MASK BLEND"),
    number("material", "alphaCutoff").not_negative(),
    truth("material", "doubleSided"),
    numbers("pbr", "baseColorFactor", 4).between(0, 1),
    object("pbr", "baseColorTexture", "texture info"),
    number("pbr", "metallicFactor").between(0, 1),
    number("pbr", "roughnessFactor").between(0, 1),
    object("pbr", "metallicRoughnessTexture", "texture info"),
    index("texture info", "index", "textures").required(),
    whole("texture info", "texCoord"),
    number("texture info", "scale"),
    number("texture info", "strength").between(0, 1),

    object("texture info extensions", "KHR_texture_transform", "texture transform"),
    numbers("texture transform", "offset", 2).between(-1e18, 1e18),
    number("texture transform", "rotation").between(-1e18, 1e18),
    numbers("texture transform", "scale", 2).between(-1e18, 1e18),
    whole("texture transform", "texCoord"),

    text("mesh", "name"),
    objects("mesh", "primitives", "primitive").required(),
    numbers("mesh", "weights", 0),
    index_map("primitive", "attributes", "accessors"),
    index("primitive", "indices", "accessors"),
    index("primitive", "material", "materials"),
    whole("primitive", "mode"),
    index_maps("primitive", "targets", "accessors"),

    text("node", "name"),
    index("node", "camera", "cameras"),
    indices("node", "children", "nodes"),
    numbers("node", "matrix", 16),
    index("node", "mesh", "meshes"),
    numbers("node", "rotation", 4),
    numbers("node", "scale", 3),
    index("node", "skin", "skins"),
    numbers("node", "translation", 3),
    numbers("node", "weights", 0),

    whole("sampler", "magFilter", "9728 9729"),
    whole("sampler", "minFilter", "9728 9729 9984 9985 9986 9987"),
    whole("sampler", "wrapS", "33071 33648 10497"),
    whole("sampler", "wrapT", "33071 33648 10497"),

    text("scene", "name"),
    indices("scene", "nodes", "nodes"),

    text("skin", "name"),
    index("skin", "inverseBindMatrices", "accessors"),
    index("skin", "skeleton", "nodes"),
    indices("skin", "joints", "nodes").required(),

    text("texture", "name"),
    index("texture", "sampler", "samplers"),
    index("texture", "source", "images"),

    object("root extensions", "KHR_lights_punctual", "lights"),
    objects("lights", "lights", "light").required(),
    text("light", "name"),
    text("light", "type").required(),
    numbers("light", "color", 3).not_negative(),
    number("light", "intensity").not_negative(),
    number("light", "range").positive(),
    object("light", "spot", "spot"),
    number("spot", "innerConeAngle").between(0, 1.5707963267948966),
    number("spot", "outerConeAngle").between(0, 1.5707963267948968),
    object("node extensions", "KHR_lights_punctual", "light reference"),
    index("light reference", "light", lights_array).required(),

    object("primitive extensions", "EXT_implicit_geometry", "implicit geometry"),
    object("implicit geometry", "sphere", "implicit sphere"),
    object("implicit geometry", "box", "implicit box"),
    number("implicit sphere", "radius").positive().required(),
    numbers("implicit box", "size", 3).not_negative().required(),
    object("root extensions", "KHR_implicit_shapes", "shapes"),
    objects("shapes", "shapes", "shape").required(),
    text("shape", "type").required(),
    object("shape", "sphere", "sphere"),
    object("shape", "box", "box"),
    number("sphere", "radius").positive(),
    numbers("box", "size", 3).positive(),
    object("primitive extensions", "KHR_implicit_shapes", "shape reference"),
    index("shape reference", "shape", shapes_array).required(),

    object("node extensions", "EXT_mesh_gpu_instancing", "instancing"),
    index_map("instancing", "attributes", "accessors").required(),

    object("material extensions", "TANDEM_materials_phong", "phong"),
    numbers("phong", "ambient", 3).between(0, 1),
    numbers("phong", "diffuse", 3).between(0, 1),
    numbers("phong", "specular", 3).between(0, 1),
    number("phong", "shininess").between(0, 1e8),
    numbers("phong", "mirror", 3).between(0, 1),
    object("material extensions", "TANDEM_materials_dielectric", "dielectric"),
    whole("dielectric", "priority").between(0, 127),
    object("material extensions", "KHR_materials_unlit", "unlit"),
    object("material extensions", "KHR_materials_transmission", "transmission"),
    number("transmission", "transmissionFactor").between(0, 1),
    object("transmission", "transmissionTexture", "texture info"),
    object("material extensions", "KHR_materials_ior", "refractive index"),
    number("refractive index", "ior").between(0, 1e3),
    object("material extensions", "KHR_materials_volume", "volume"),
    number("volume", "thicknessFactor").not_negative(),
    object("volume", "thicknessTexture", "texture info"),
    number("volume", "attenuationDistance").positive(),
    numbers("volume", "attenuationColor", 3).between(0, 1),
    object("light extensions", "TANDEM_lights_phong", "phong light"),
    truth("phong light", "falloff"),
    truth("phong light", "shadows"),
    object("root extensions", "TANDEM_environment", "environment"),
    object("scene extensions", "TANDEM_environment", "environment"),
    object("environment", "gradient", "gradient"),
    numbers("environment", "ambient", 3).not_negative(),
    truth("environment", "illuminates"),
    truth("environment", "indirect"),
    object("root extensions", "TANDEM_display", "display"),
    object("scene extensions", "TANDEM_display", "display"),
    text("display", "transfer", "srgb linear"),
    number("display", "exposure").between(-most_exposure_stops, most_exposure_stops),
    object("camera extensions", "TANDEM_camera_lens", "lens"),
    number("lens", "apertureRadius").not_negative().required(),
    number("lens", "focusDistance").positive().required(),
    whole("lens", "blades").between(0, 32),
    number("lens", "rotation"),
    object("camera extensions", "TANDEM_camera_shutter", "shutter"),
    number("shutter", "open").required(),
    number("shutter", "close").required(),
    whole("shutter", "instants").between(1, 1024),
    object("material extensions", "KHR_materials_emissive_strength", "emissive strength"),
    number("emissive strength", "emissiveStrength").not_negative(),
    numbers("gradient", "bottom", 3).not_negative().required(),
    numbers("gradient", "top", 3).not_negative().required(),
};

std::string range_words(const Property& property) {
    if (property.low == smallest && property.high == largest) return " above 0";
    if (property.low == -largest && property.high == largest) return "";
    if (property.high >= largest) return fmt::format(" of {} or more", property.low);
    if (property.low == smallest) return fmt::format(" above 0 and up to {}", property.high);
    return fmt::format(" from {} to {}", property.low, property.high);
}

/// The rows of an owner.
const std::vector<const Property*>& properties_of(const std::string& owner) {
    static const auto by_owner = [] {
        std::map<std::string, std::vector<const Property*>> rows;
        for (const Property& property : properties) rows[property.owner].push_back(&property);
        return rows;
    }();
    static const std::vector<const Property*> none;
    const auto found = by_owner.find(owner);
    return found == by_owner.end() ? none : found->second;
}

class Checker {
  public:
    explicit Checker(Document& document) : document_(document) {}

    /// What indices point into comes first, so that a wrong array is named and not the indices into it.
    void check_root() {
        Json& root = document_.json;
        static const std::string root_kind = "root";
        for (const Property* property : properties_of(root_kind)) {
            const auto member = root.find(property->name);
            if (member == root.end() || property->kind != Kind::objects) continue;
            require(member->is_array(), property->name, "an array of objects", *member);
        }
        check_extensions(root, "root", "");
        check_properties(root, "root", "");
    }

  private:
    void check_object(Json& value, const std::string& kind, const std::string& path) {
        require(value.is_object(), path, "an object", value);
        check_properties(value, kind, path);
        check_extensions(value, kind, path);
    }

    /// `path` is empty for the root.
    static std::string member_path(const std::string& path, const std::string& name) {
        return path.empty() ? name : path + "." + name;
    }

    void check_properties(Json& value, const std::string& kind, const std::string& path) {
        for (const Property* property : properties_of(kind)) {
            const auto member = value.find(property->name);
            if (member != value.end()) {
                check_property(*member, *property, member_path(path, property->name));
            } else if (property->presence == Presence::required) {
                document_.fail(path.empty() ? "root" : path,
                               fmt::format("lacks the required property '{}'", property->name));
            }
        }
    }

    void check_extensions(Json& value, const std::string& kind, const std::string& path) {
        const auto extensions = value.find("extensions");
        if (extensions == value.end()) return;
        const std::string where = member_path(path, "extensions");
        require(extensions->is_object(), where, "an object", *extensions);
        for (const auto& [name, extension] : extensions->items()) {
            require(extension.is_object(), member_path(where, name), "an object", extension);
        }
        check_properties(*extensions, kind + " extensions", where);
    }

    void require(bool good, const std::string& path, const std::string& wanted, const Json& found) const {
        if (good) return;
        std::string shown = found.is_structured() ? fmt::format("an {}", found.type_name()) : found.dump(-1, ' ', true);
        if (shown.size() > 40) shown = shown.substr(0, 40) + "...";
        document_.fail(path, fmt::format("must be {}, but is {}", wanted, shown));
    }

    void check_property(Json& value, const Property& property, const std::string& path) {
        const auto each = [&](const std::string& wanted, auto check_element) {
            require(value.is_array(), path, wanted, value);
            for (std::size_t i = 0; i < value.size(); ++i) check_element(value[i], fmt::format("{}[{}]", path, i));
        };
        switch (property.kind) {
            case Kind::object:
                return check_object(value, property.argument, path);
            case Kind::objects:
                return each("an array of objects",
                            [&](Json& v, const std::string& p) { check_object(v, property.argument, p); });
            case Kind::index:
                return check_index(value, property.argument, path);
            case Kind::indices:
                return check_distinct_indices(value, property, path);
            case Kind::index_map:
                return check_index_map(value, property.argument, path);
            case Kind::index_maps:
                return each("an array of objects",
                            [&](Json& v, const std::string& p) { check_index_map(v, property.argument, p); });
            case Kind::whole:
                check_whole(value, path);
                require(value.get<double>() >= property.low && value.get<double>() <= property.high, path,
                        "a whole number" + range_words(property), value);
                return check_choice(std::to_string(value.get<std::int64_t>()), property, path, value);
            case Kind::number:
                return check_number(value, property, path);
            case Kind::numbers:
                each("an array of numbers", [&](Json& v, const std::string& p) { check_number(v, property, p); });
                return require(property.count == 0 || value.size() == property.count, path,
                               fmt::format("{} numbers", property.count), value);
            case Kind::text:
                require(value.is_string(), path, "a string", value);
                return check_choice(value.get<std::string>(), property, path, value);
            case Kind::texts:
                return each("an array of strings",
                            [&](const Json& v, const std::string& p) { require(v.is_string(), p, "a string", v); });
            case Kind::truth:
                return require(value.is_boolean(), path, "true or false", value);
        }
    }

    void check_number(const Json& value, const Property& property, const std::string& path) const {
        const bool good =
            value.is_number() && value.get<double>() >= property.low && value.get<double>() <= property.high;
        require(good, path, "a number" + range_words(property), value);
    }

    /// A whole number, of 0 or more.
    void check_whole(Json& value, const std::string& path) const {
        if (value.is_number_float()) {
            const double number = value.get<double>();
            if (std::floor(number) == number && std::abs(number) < 9e15) value = static_cast<std::int64_t>(number);
        }
        require(value.is_number_unsigned() || (value.is_number_integer() && value.get<std::int64_t>() >= 0), path,
                "a whole number of 0 or more", value);
    }

    void check_index(Json& value, const char* array, const std::string& path) {
        check_whole(value, path);
        const auto [known, is_new] = lengths_.try_emplace(array, 0);
        if (is_new) known->second = document_.length(array);
        const std::size_t length = known->second;
        const auto wanted = value.get<std::uint64_t>();
        if (wanted < length) return;
        std::string dotted = array;
        std::replace(dotted.begin(), dotted.end(), '/', '.');
        document_.fail(path, fmt::format("is {}, but the file's array '{}' has {} elements{}", wanted, dotted, length,
                                         length == 0 ? "" : fmt::format("; use 0 to {}", length - 1)));
    }

    void check_distinct_indices(Json& value, const Property& property, const std::string& path) {
        require(value.is_array(), path, "an array of indices", value);
        std::set<std::uint64_t> seen;
        for (std::size_t i = 0; i < value.size(); ++i) {
            const std::string at = fmt::format("{}[{}]", path, i);
            check_index(value[i], property.argument, at);
            if (!seen.insert(value[i].get<std::uint64_t>()).second) {
                document_.fail(at, fmt::format("names {} a second time", value[i].get<std::uint64_t>()));
            }
        }
    }

    void check_index_map(Json& value, const char* array, const std::string& path) {
        require(value.is_object(), path, "an object of indices", value);
        for (auto& [name, element] : value.items()) check_index(element, array, member_path(path, name));
    }

    void check_choice(const std::string& found, const Property& property, const std::string& path,
                      const Json& value) const {
        const std::string choices = property.argument;
        if (choices.empty()) return;
        const bool known = found.find(' ') == std::string::npos && !found.empty() &&
                           (" " + choices + " ").find(" " + found + " ") != std::string::npos;
        require(known, path, "one of " + choices, value);
    }

    Document& document_;
    std::map<std::string, std::size_t> lengths_;  ///< of the root's arrays
};

}  // namespace

void check_schema(Document& document) { Checker(document).check_root(); }

}  // namespace tandem::gltf
