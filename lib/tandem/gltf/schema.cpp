#include "tandem/gltf/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "tandem/gltf/buffers.h"
#include "tandem/gltf/schema_property.h"
#include "tandem/gltf/structure.h"

namespace tandem::gltf {

namespace {

using schema::Care;
using schema::Kind;
using schema::largest;
using schema::most_whole;
using schema::Presence;
using schema::Property;
using schema::smallest;

/// The range as text. `found`: the value that is not in it.
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
        for (const Property& property : schema::all_properties()) rows[property.owner].push_back(&property);
        return rows;
    }();
    static const std::vector<const Property*> none;
    const auto found = by_owner.find(owner);
    return found == by_owner.end() ? none : found->second;
}

/// Whether an empty object may replace one that is left out.
bool may_be_empty(const std::string& kind) {
    const auto& rows = properties_of(kind);
    return std::none_of(rows.begin(), rows.end(), [](const Property* row) { return row->care == Care::strict; });
}

/// A check of an object as a whole, beside those of its properties.
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

    /// Runs `check` on a member of `owner`, and treats a flaw according to the property's care.
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
        std::vector<std::string> others;  // which the table does not describe
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

    /// Checks an array. An element that is left out keeps its place, so that other indices stay valid: it becomes an
    /// empty object if its kind allows that, else a string with the reason.
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
                    fmt::format("is {}; glTF allows {} at most, but Tandem accepts it", found, property.usual));
            }
            return;
        }
        require(property.is_clamped && std::abs(found) <= largest, path, wanted, value);
        const double nearest = std::clamp(found, property.low, property.high);
        flaws_.replace(property.name, path, fmt::format("{}; Tandem uses {}", not_what(wanted, value), nearest));
        value = nearest;
    }

    /// Checks a whole number of 0 or more.
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

    /// An array that indices refer to; empty if the file has none. `pointer`: a JSON pointer without the first slash.
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
