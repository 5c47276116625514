#include "tandem/gltf/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "tandem/film/display.h"
#include "tandem/gltf/buffers.h"
#include "tandem/gltf/structure.h"

namespace tandem::gltf {

namespace {

enum class Kind { object, objects, index, indices, index_map, index_maps, whole, number, numbers, text, texts, truth };
enum class Presence { optional, required };

/// What becomes of a property whose value is not what it must be.
enum class Care {
    lenient,  ///< it is left out, and the file is drawn without it
    strict,   ///< the object that has it is left out
    vital,    ///< the file is refused: the picture would be another one
};

constexpr double infinity = std::numeric_limits<double>::infinity();
/// The largest float: a number that Tandem keeps as a float must not overflow there.
constexpr double largest = 3.4028234663852886e38;
constexpr double most_whole = 9007199254740992;  // 2^53
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
    Care care = Care::lenient;
    bool is_clamped = false;  ///< number(s): a finite one out of the range becomes the nearest in it
    double usual = infinity;  ///< number(s): glTF's own limit, where Tandem has a higher one

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
/// A whole number of 0 or more, below 2^53; or one of `choices`, between spaces.
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

constexpr const char* lights_array = "extensions/KHR_lights_punctual/lights";
constexpr const char* shapes_array = "extensions/KHR_implicit_shapes/shapes";

constexpr Care strict = Care::strict;
constexpr Care vital = Care::vital;

/// glTF 2.0, section 5, and the extensions that Tandem reads. Every object may also have `extensions` and, except
/// the ones inside of extensions, a `name`. The arrays of the root come in an order in which what is pointed at comes
/// before what points at it.
///
/// Lenient is what other viewers do without: names, looks, cameras, lights, animations. Strict is what says how bytes
/// are to be read. Vital is where geometry stands, and Tandem's own extensions, whose authors look for such an error.
constexpr Property properties[] = {
    object("root", "asset", "asset").required(),
    texts("root", "extensionsUsed"),
    texts("root", "extensionsRequired").with(vital),
    objects("root", "buffers", "buffer").with(vital),
    objects("root", "bufferViews", "buffer view").with(vital),
    objects("root", "accessors", "accessor").with(vital),
    objects("root", "images", "image"),
    objects("root", "samplers", "sampler"),
    objects("root", "textures", "texture"),
    objects("root", "materials", "material"),
    objects("root", "cameras", "camera"),
    objects("root", "meshes", "mesh").with(vital),
    objects("root", "skins", "skin"),  // no node is ever left out
    objects("root", "nodes", "node").with(vital),
    objects("root", "scenes", "scene"),
    index("root", "scene", "scenes"),
    objects("root", "animations", "animation"),

    text("asset", "version").required(),
    text("asset", "minVersion"),

    text("accessor", "name"),
    index("accessor", "bufferView", "bufferViews").with(strict),
    whole("accessor", "byteOffset").with(strict),
    whole("accessor", "componentType", "5120 5121 5122 5123 5125 5126").required(),
    truth("accessor", "normalized"),
    whole("accessor", "count").between(1, most_whole).required(),
    text("accessor", "type", "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4").required(),
    numbers("accessor", "max", 0),
    numbers("accessor", "min", 0),
    object("accessor", "sparse", "sparse").with(strict),
    whole("sparse", "count").between(1, most_whole).required(),
    object("sparse", "indices", "sparse indices").required(),
    object("sparse", "values", "sparse values").required(),
    index("sparse indices", "bufferView", "bufferViews").required(),
    whole("sparse indices", "byteOffset").with(strict),
    whole("sparse indices", "componentType", "5121 5123 5125").required(),
    index("sparse values", "bufferView", "bufferViews").required(),
    whole("sparse values", "byteOffset").with(strict),

    text("animation", "name"),
    objects("animation", "channels", "channel").required(),
    objects("animation", "samplers", "animation sampler").required(),
    whole("channel", "sampler").required(),
    object("channel", "target", "target").required(),
    index("target", "node", "nodes").with(strict),
    text("target", "path").required(),
    index("animation sampler", "input", "accessors").required(),
    text("animation sampler", "interpolation", "LINEAR STEP CUBICSPLINE").with(strict),
    index("animation sampler", "output", "accessors").required(),

    text("buffer", "name"),
    text("buffer", "uri").with(strict),
    whole("buffer", "byteLength").between(1, most_whole).required(),

    text("buffer view", "name"),
    index("buffer view", "buffer", "buffers").required(),
    whole("buffer view", "byteOffset").with(strict),
    whole("buffer view", "byteLength").between(1, most_whole).required(),
    whole("buffer view", "byteStride").between(0, 1 << 30).with(strict),
    whole("buffer view", "target", "34962 34963"),

    text("camera", "name"),
    text("camera", "type", "perspective orthographic").required(),
    object("camera", "perspective", "perspective"),
    object("camera", "orthographic", "orthographic"),
    number("perspective", "aspectRatio").positive(),
    number("perspective", "yfov").between(smallest, 3.14159).required(),
    number("perspective", "zfar").positive(),
    number("perspective", "znear").positive(),
    number("orthographic", "xmag"),
    number("orthographic", "ymag").positive().required(),
    number("orthographic", "zfar"),
    number("orthographic", "znear"),

    text("image", "name"),
    text("image", "uri"),
    text("image", "mimeType"),
    index("image", "bufferView", "bufferViews"),

    text("material", "name"),
    object("material", "pbrMetallicRoughness", "pbr"),
    object("material", "normalTexture", "texture info"),
    object("material", "occlusionTexture", "texture info"),
    object("material", "emissiveTexture", "texture info"),
    numbers("material", "emissiveFactor", 3).between(0, largest).clamped().usually_up_to(1),
    text("material", "alphaMode", "OPAQUE MASK BLEND"),
    number("material", "alphaCutoff").not_negative().clamped(),
    truth("material", "doubleSided"),
    numbers("pbr", "baseColorFactor", 4).between(0, 1).clamped(),
    object("pbr", "baseColorTexture", "texture info"),
    number("pbr", "metallicFactor").between(0, 1),
    number("pbr", "roughnessFactor").between(0, 1),
    object("pbr", "metallicRoughnessTexture", "texture info"),
    index("texture info", "index", "textures").required(),
    whole("texture info", "texCoord"),
    number("texture info", "scale"),
    number("texture info", "strength").between(0, 1).clamped(),

    object("texture info extensions", "KHR_texture_transform", "texture transform"),
    numbers("texture transform", "offset", 2).between(-1e18, 1e18),
    number("texture transform", "rotation").between(-1e18, 1e18),
    numbers("texture transform", "scale", 2).between(-1e18, 1e18),
    whole("texture transform", "texCoord"),

    text("mesh", "name"),
    objects("mesh", "primitives", "primitive").required(),
    numbers("mesh", "weights", 0),
    index_map("primitive", "attributes", "accessors"),
    index("primitive", "indices", "accessors").with(strict),
    index("primitive", "material", "materials"),
    whole("primitive", "mode").with(strict),
    index_maps("primitive", "targets", "accessors"),

    text("node", "name"),
    index("node", "camera", "cameras"),
    indices("node", "children", "nodes"),
    numbers("node", "matrix", 16).with(vital),
    index("node", "mesh", "meshes"),
    numbers("node", "rotation", 4).with(vital),
    numbers("node", "scale", 3).with(vital),
    index("node", "skin", "skins"),
    numbers("node", "translation", 3).with(vital),
    numbers("node", "weights", 0),

    whole("sampler", "magFilter", "9728 9729"),
    whole("sampler", "minFilter", "9728 9729 9984 9985 9986 9987"),
    whole("sampler", "wrapS", "33071 33648 10497"),
    whole("sampler", "wrapT", "33071 33648 10497"),

    text("scene", "name"),
    indices("scene", "nodes", "nodes"),

    text("skin", "name"),
    index("skin", "inverseBindMatrices", "accessors").with(strict),
    index("skin", "skeleton", "nodes"),
    indices("skin", "joints", "nodes").required(),

    text("texture", "name"),
    index("texture", "sampler", "samplers"),
    index("texture", "source", "images"),

    object("root extensions", "KHR_lights_punctual", "lights"),
    objects("lights", "lights", "light").required(),
    text("light", "name"),
    text("light", "type").required(),
    numbers("light", "color", 3).not_negative().clamped(),
    number("light", "intensity").not_negative().clamped(),
    number("light", "range").positive(),
    object("light", "spot", "spot"),
    number("spot", "innerConeAngle").between(0, 1.5707963267948966).clamped(),
    number("spot", "outerConeAngle").between(0, 1.5707963267948968).clamped(),
    object("node extensions", "KHR_lights_punctual", "light reference"),
    index("light reference", "light", lights_array).required(),

    object("primitive extensions", "EXT_implicit_geometry", "implicit geometry").with(strict),
    object("implicit geometry", "sphere", "implicit sphere").with(strict),
    object("implicit geometry", "box", "implicit box").with(strict),
    number("implicit sphere", "radius").positive().required(),
    numbers("implicit box", "size", 3).not_negative().required(),
    object("root extensions", "KHR_implicit_shapes", "shapes"),
    objects("shapes", "shapes", "shape").required(),
    text("shape", "type").required(),
    object("shape", "sphere", "sphere").with(strict),
    object("shape", "box", "box").with(strict),
    number("sphere", "radius").positive().with(strict),
    numbers("box", "size", 3).positive().with(strict),
    object("primitive extensions", "KHR_implicit_shapes", "shape reference").with(strict),
    index("shape reference", "shape", shapes_array).required(),

    object("node extensions", "EXT_mesh_gpu_instancing", "instancing").with(vital),
    index_map("instancing", "attributes", "accessors").required(),

    object("material extensions", "TANDEM_materials_phong", "phong").with(vital),
    numbers("phong", "ambient", 3).between(0, 1),
    numbers("phong", "diffuse", 3).between(0, 1),
    numbers("phong", "specular", 3).between(0, 1),
    number("phong", "shininess").between(0, 1e8),
    numbers("phong", "mirror", 3).between(0, 1),
    object("material extensions", "TANDEM_materials_dielectric", "dielectric").with(vital),
    whole("dielectric", "priority").between(0, 127),
    object("material extensions", "KHR_materials_unlit", "unlit"),
    object("material extensions", "KHR_materials_transmission", "transmission"),
    number("transmission", "transmissionFactor").between(0, 1).clamped(),
    object("transmission", "transmissionTexture", "texture info"),
    object("material extensions", "KHR_materials_ior", "refractive index"),
    number("refractive index", "ior").between(0, 1e3).clamped(),
    object("material extensions", "KHR_materials_volume", "volume"),
    number("volume", "thicknessFactor").not_negative().clamped(),
    object("volume", "thicknessTexture", "texture info"),
    number("volume", "attenuationDistance").positive(),
    numbers("volume", "attenuationColor", 3).between(0, 1).clamped(),
    object("light extensions", "TANDEM_lights_phong", "phong light").with(vital),
    truth("phong light", "falloff"),
    truth("phong light", "shadows"),
    object("root extensions", "TANDEM_environment", "environment").with(vital),
    object("scene extensions", "TANDEM_environment", "environment").with(vital),
    object("environment", "gradient", "gradient"),
    numbers("environment", "ambient", 3).not_negative(),
    truth("environment", "illuminates"),
    truth("environment", "indirect"),
    object("root extensions", "TANDEM_display", "display").with(vital),
    object("scene extensions", "TANDEM_display", "display").with(vital),
    text("display", "transfer", "srgb linear"),
    number("display", "exposure").between(-most_exposure_stops, most_exposure_stops),
    object("camera extensions", "TANDEM_camera_lens", "lens").with(vital),
    number("lens", "apertureRadius").not_negative().required(),
    number("lens", "focusDistance").positive().required(),
    whole("lens", "blades").between(0, 32),
    number("lens", "rotation"),
    object("camera extensions", "TANDEM_camera_shutter", "shutter").with(vital),
    number("shutter", "open").required(),
    number("shutter", "close").required(),
    whole("shutter", "instants").between(1, 1024),
    object("material extensions", "KHR_materials_emissive_strength", "emissive strength"),
    number("emissive strength", "emissiveStrength").not_negative().clamped(),
    numbers("gradient", "bottom", 3).not_negative().required(),
    numbers("gradient", "top", 3).not_negative().required(),
};

/// `found`: what is there in place of a number of the range.
std::string range_words(const Property& property, const Json& found) {
    if (property.low == smallest && property.high == largest) return " above 0";
    if (property.low == -largest && property.high == largest) {
        return found.is_number() ? fmt::format(" from {} to {}", -largest, largest) : "";
    }
    if (property.high >= most_whole) return fmt::format(" of {} or more", property.low);
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

/// May an empty object take the place of one that is left out?
bool may_be_empty(const std::string& kind) {
    const auto& rows = properties_of(kind);
    return std::none_of(rows.begin(), rows.end(), [](const Property* row) { return row->care == Care::strict; });
}

/// What an object must be as a whole, beside its properties one by one.
using Rule = void (*)(const Document& document, FlawLog& flaws, Json& object, const std::string& path);

Rule rule_of(const std::string& kind) {
    static const std::map<std::string, Rule> rules = {{"buffer", check_buffer},      {"buffer view", check_buffer_view},
                                                      {"accessor", check_accessor},  {"camera", check_camera},
                                                      {"image", check_image},        {"node", check_node},
                                                      {"animation", check_animation}};
    const auto found = rules.find(kind);
    return found == rules.end() ? nullptr : found->second;
}

class Checker {
  public:
    Checker(Document& document, FlawLog& flaws) : document_(document), flaws_(flaws) {}

    void check_root() {
        Json& root = document_.json;
        static const std::string root_kind = "root";
        for (const Property* property : properties_of(root_kind)) {
            if (property->kind != Kind::objects || !root.contains(property->name)) continue;
            take(root, *property, [&](const Json& member) {
                require(member.is_array(), property->name, "an array of objects", member);
            });
        }
        check_extensions(root, "root", "");
        check_properties(root, "root", "");
    }

  private:
    void check_object(Json& value, const std::string& kind, const std::string& path) {
        require(value.is_object(), path, "an object", value);
        check_properties(value, kind, path);
        check_extensions(value, kind, path);
        if (const Rule rule = rule_of(kind)) rule(document_, flaws_, value, path);
    }

    /// `path` is empty for the root.
    static std::string member_path(const std::string& path, const std::string& name) {
        return path.empty() ? name : path + "." + name;
    }

    void check_properties(Json& value, const std::string& kind, const std::string& path) {
        for (const Property* property : properties_of(kind)) {
            if (value.contains(property->name)) {
                const std::string where = member_path(path, property->name);
                take(value, *property, [&](Json& member) { check_property(member, *property, where); });
            } else if (property->presence == Presence::required) {
                document_.fail(path.empty() ? "root" : path,
                               fmt::format("lacks the required property '{}'", property->name));
            }
        }
    }

    /// Runs `check` on a member of `owner`, and does with a flaw of it what the property's care says.
    template <class Check>
    void take(Json& owner, const Property& property, Check check) {
        try {
            check(owner[property.name]);
        } catch (const Flaw& flaw) {
            if (property.care == Care::vital) document_.refuse(flaw);
            if (property.care == Care::strict || is_in_vital_) throw;
            leave_out(owner, property.name, flaw);
        }
    }

    void leave_out(Json& owner, const std::string& name, const Flaw& flaw) {
        owner.erase(name);
        arrays_.clear();
        flaws_.leave_out(name, flaw);
    }

    void check_extensions(Json& value, const std::string& kind, const std::string& path) {
        const auto extensions = value.find("extensions");
        if (extensions == value.end()) return;
        const std::string where = member_path(path, "extensions");
        try {
            require(extensions->is_object(), where, "an object", *extensions);
        } catch (const Flaw& flaw) {
            return leave_out(value, "extensions", flaw);
        }
        check_properties(*extensions, kind + " extensions", where);
        std::vector<std::string> others;  // whose types the table does not have
        for (const auto& [name, extension] : extensions->items()) {
            if (!extension.is_object()) others.push_back(name);
        }
        for (const std::string& name : others) {
            const Flaw flaw(document_.file, member_path(where, name), not_what("an object", (*extensions)[name]));
            leave_out(*extensions, name, flaw);
        }
    }

    static std::string not_what(const std::string& wanted, const Json& found) {
        std::string shown = found.is_array()    ? fmt::format("an array of {}", found.size())
                            : found.is_object() ? "an object"
                                                : found.dump(-1, ' ', true);
        if (shown.size() > 40) shown = shown.substr(0, 40) + "...";
        return fmt::format("must be {}, but is {}", wanted, shown);
    }

    void require(bool good, const std::string& path, const std::string& wanted, const Json& found) const {
        if (!good) document_.fail(path, not_what(wanted, found));
    }

    void check_property(Json& value, const Property& property, const std::string& path) {
        const auto each = [&](const std::string& wanted, auto check_element) {
            require(value.is_array(), path, wanted, value);
            for (std::size_t i = 0; i < value.size(); ++i) check_element(value[i], fmt::format("{}[{}]", path, i));
        };
        switch (property.kind) {
            case Kind::object: {
                const bool outside = std::exchange(is_in_vital_, is_in_vital_ || property.care == Care::vital);
                check_object(value, property.argument, path);
                is_in_vital_ = outside;
                return;
            }
            case Kind::objects:
                return each("an array of objects",
                            [&](Json& v, const std::string& p) { check_element(v, property.argument, p); });
            case Kind::index:
                return check_index(value, property.argument, path);
            case Kind::indices:
                return check_distinct_indices(value, property, path);
            case Kind::index_map:
                return check_index_map(value, property, path);
            case Kind::index_maps:
                return each("an array of objects",
                            [&](Json& v, const std::string& p) { check_index_map(v, property, p); });
            case Kind::whole:
                check_whole(value, path);
                require(value.get<double>() >= property.low && value.get<double>() <= property.high, path,
                        "a whole number" + range_words(property, value), value);
                return check_choice(std::to_string(value.get<std::int64_t>()), property, path, value);
            case Kind::number:
                return check_number(value, property, path);
            case Kind::numbers:
                if (property.count != 0) {
                    require(value.is_array() && value.size() == property.count, path,
                            fmt::format("{} numbers", property.count), value);
                }
                return each("an array of numbers",
                            [&](Json& v, const std::string& p) { check_number(v, property, p); });
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

    /// Of an array. An element that is left out keeps its place, so that the indices of the others hold: it becomes an
    /// empty object if its kind may be one, else a string that says why.
    void check_element(Json& element, const std::string& kind, const std::string& path) {
        try {
            check_object(element, kind, path);
        } catch (const Flaw& flaw) {
            if (is_in_vital_) throw;
            element = may_be_empty(kind) ? Json::object() : Json(flaw.root());
            flaws_.leave_out(kind, flaw);
        }
    }

    void check_number(Json& value, const Property& property, const std::string& path) {
        const std::string wanted = "a number" + range_words(property, value);
        require(value.is_number(), path, wanted, value);
        const double found = value.get<double>();
        if (found >= property.low && found <= property.high) {
            if (found > property.usual) {
                flaws_.tolerate(
                    property.name, path,
                    fmt::format("is {}; glTF has {} at most, and Tandem takes it all the same", found, property.usual));
            }
            return;
        }
        require(property.is_clamped && std::abs(found) <= largest, path, wanted, value);
        const double nearest = std::clamp(found, property.low, property.high);
        flaws_.replace(property.name, path, fmt::format("{}; Tandem takes {}", not_what(wanted, value), nearest));
        value = nearest;
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
        const Json& elements = array_of(array);
        const std::size_t length = elements.size();
        const auto wanted = value.get<std::uint64_t>();
        std::string dotted = array;
        std::replace(dotted.begin(), dotted.end(), '/', '.');
        if (wanted >= length) {
            document_.fail(path, fmt::format("is {}, but the file's array '{}' has {} elements{}", wanted, dotted,
                                             length, length == 0 ? "" : fmt::format("; use 0 to {}", length - 1)));
        }
        if (!elements[wanted].is_string()) return;
        const auto& why = elements[wanted].get_ref<const std::string&>();
        throw Flaw(document_.file, path, fmt::format("names {}[{}], which is left out ({})", dotted, wanted, why), why);
    }

    /// An array that indices point into; empty if the file has none. `pointer`: a JSON pointer, less the first slash.
    const Json& array_of(const char* pointer) {
        static const Json none = Json::array();
        const auto [known, is_new] = arrays_.try_emplace(pointer, &none);
        if (is_new) {
            const Json::json_pointer place(std::string("/") + pointer);
            if (document_.json.contains(place) && document_.json[place].is_array()) {
                known->second = &document_.json[place];
            }
        }
        return *known->second;
    }

    void check_distinct_indices(Json& value, const Property& property, const std::string& path) {
        require(value.is_array(), path, "an array of indices", value);
        std::set<std::uint64_t> seen;
        Json good = Json::array();
        for (std::size_t i = 0; i < value.size(); ++i) {
            const std::string at = fmt::format("{}[{}]", path, i);
            try {
                check_index(value[i], property.argument, at);
                if (!seen.insert(value[i].get<std::uint64_t>()).second) {
                    document_.fail(at, fmt::format("names {} a second time", value[i].get<std::uint64_t>()));
                }
                good.push_back(value[i]);
            } catch (const Flaw& flaw) {
                if (property.care != Care::lenient) throw;
                flaws_.leave_out(property.name, flaw);
            }
        }
        if (good.size() != value.size()) value = std::move(good);
    }

    void check_index_map(Json& value, const Property& property, const std::string& path) {
        require(value.is_object(), path, "an object of indices", value);
        std::vector<std::pair<std::string, Flaw>> bad;
        for (auto& [name, element] : value.items()) {
            try {
                check_index(element, property.argument, member_path(path, name));
            } catch (const Flaw& flaw) {
                if (property.care != Care::lenient || is_in_vital_) throw;
                bad.emplace_back(name, flaw);
            }
        }
        for (const auto& [name, flaw] : bad) leave_out(value, name, flaw);
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
    FlawLog& flaws_;
    bool is_in_vital_ = false;  ///< within an object whose every property is vital
    std::map<std::string, const Json*> arrays_;
};

}  // namespace

void check_schema(Document& document, FlawLog& flaws) { Checker(document, flaws).check_root(); }

}  // namespace tandem::gltf
