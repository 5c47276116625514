#include "tandem/compile/copies.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>

#include "tandem/base/large_array.h"
#include "tandem/base/parallel.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/shapes/hit.h"

namespace tandem {

namespace {

/// What identifies a primitive, beside its material: 32-bit words without padding.
const Sphere& shape_of(const Sphere& sphere) { return sphere; }
const Box& shape_of(const Box& box) { return box; }
const Placement& shape_of(const Placement& body) { return body; }
struct TriangleShape {
    Vec3f corner[3];
    FaceSides sides;
};
TriangleShape shape_of(const Triangle& face) { return {{face.v0, face.v1, face.v2}, face.attributes.sides}; }
struct QuadShape {
    Vec3f corner[4];
    FaceSides sides;
};
QuadShape shape_of(const Quad& face) { return {{face.v0, face.v1, face.v2, face.v3}, face.attributes.sides}; }

/// Whether the alpha mask of a face depends on the values at its corners.
template <class Primitive>
bool may_have_holes(const Primitive& primitive, const MaterialTextures* textures) {
    if constexpr (requires { primitive.attributes; }) {
        return textures != nullptr && textures->alpha_cutoff > 0 && primitive.attributes.texcoords != no_attributes;
    }
    return false;
}

/// The bits of a shape.
template <class Shape>
auto words_of(const Shape& shape) {
    std::array<std::uint64_t, (sizeof(Shape) + 7) / 8> words{};
    std::memcpy(words.data(), &shape, sizeof(shape));
    return words;
}

template <class Shape>
std::uint64_t hash_of(const Shape& shape, std::uint32_t material) {
    std::uint64_t hash = material;
    for (const std::uint64_t word : words_of(shape)) hash = (std::rotl(hash, 23) ^ word) * 0x9E3779B97F4A7C15U;
    return hash ^ hash >> 32;
}

template <class Shape>
bool same_bits(const Shape& a, const Shape& b) {
    return words_of(a) == words_of(b);
}

/// Finds most of the hashes that occur only once: two bits of a word stand for a hash, and some hashes share them.
/// Threads may add hashes at the same time.
class Sieve {
  public:
    explicit Sieve(std::size_t hashes) : words_(std::bit_ceil(hashes / 8 + 1)) {
        make_large(once_, words_, words_);
        make_large(again_, words_, words_);
    }

    void prefetch(std::uint64_t hash) const { __builtin_prefetch(&once_[word_of(hash)], 1); }
    void prefetch_again(std::uint64_t hash) const { __builtin_prefetch(&again_[word_of(hash)]); }

    void add(std::uint64_t hash) {
        if (!set(once_, hash)) (void)set(again_, hash);
    }

    /// True for all hashes that were added more than once, and for few others. All must have been added.
    [[nodiscard]] bool may_repeat(std::uint64_t hash) const {
        return (again_[word_of(hash)] & bits_of(hash)) == bits_of(hash);
    }

  private:
    [[nodiscard]] std::size_t word_of(std::uint64_t hash) const { return (hash >> 32) & (words_ - 1); }
    static std::uint64_t bits_of(std::uint64_t hash) {
        return std::uint64_t{1} << (hash & 63) | std::uint64_t{1} << (hash >> 6 & 63);
    }

    /// Whether any of the bits was not set before. Many threads may read a word, but only one at a time writes to it.
    [[nodiscard]] bool set(std::vector<std::uint64_t>& words, std::uint64_t hash) const {
        const std::atomic_ref<std::uint64_t> word(words[word_of(hash)]);
        const std::uint64_t bits = bits_of(hash);
        if ((word.load(std::memory_order_relaxed) & bits) == bits) return false;
        return (word.fetch_or(bits, std::memory_order_relaxed) & bits) != bits;
    }

    std::size_t words_;
    std::vector<std::uint64_t> once_, again_;
};

class Finder {
  public:
    explicit Finder(const PreparedScene& scene) : scene_(scene) {}

    std::vector<PrimitiveCopy> run() {
#define TANDEM_PRIMITIVE(Type, name, names) search(scene_.names);
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
        return std::move(copies_);
    }

  private:
    static constexpr std::uint32_t empty = 0xFFFFFFFFU;
    static constexpr std::size_t batch = 32, chunk_size = 1U << 16;

    /// A primitive that is not a copy, and a part of its hash, which rules out most other primitives without reading
    /// this one.
    struct Entry {
        std::uint32_t hash;
        std::uint32_t number;
    };

    /// Searches the primitives of one kind. Only the suspects, few of millions, are compared, in the order of their
    /// ids.
    template <class Primitive>
    void search(const std::vector<Primitive>& primitives) {
        const std::uint32_t* material_of = scene_.material_of.data() + first_id_;
        const auto hash = [&](std::uint32_t i) { return hash_of(shape_of(primitives[i]), material_of[i]); };
        const std::vector<std::uint32_t> suspects = find_suspects(primitives.size(), hash);
        table_.assign(std::bit_ceil(suspects.size() + suspects.size() / 2 + 1), {0, empty});
        const auto prefetch = [this](std::uint64_t h) { __builtin_prefetch(&table_[place_of(h)], 1); };
        for_each_hash(
            0, suspects.size(), [&](std::size_t i) { return hash(suspects[i]); }, prefetch,
            [&](std::size_t i, std::uint64_t h) { add(primitives, material_of, suspects[i], h); });
        first_id_ += static_cast<std::uint32_t>(primitives.size());
    }

    /// The numbers below `count` whose hashes may occur more than once.
    template <class Hash>
    static std::vector<std::uint32_t> find_suspects(std::size_t count, const Hash& hash) {
        Sieve sieve(count);
        const auto hash_at = [&](std::size_t i) { return hash(static_cast<std::uint32_t>(i)); };
        for_each_chunk(count, chunk_size, [&](const Chunk& chunk) {
            for_each_hash(
                chunk.begin, chunk.end, hash_at, [&](std::uint64_t h) { sieve.prefetch(h); },
                [&](std::size_t, std::uint64_t h) { sieve.add(h); });
        });
        std::vector<std::vector<std::uint32_t>> found(chunk_count(count, chunk_size));
        for_each_chunk(count, chunk_size, [&](const Chunk& chunk) {
            for_each_hash(
                chunk.begin, chunk.end, hash_at, [&](std::uint64_t h) { sieve.prefetch_again(h); },
                [&](std::size_t i, std::uint64_t h) {
                    if (sieve.may_repeat(h)) found[chunk.number].push_back(static_cast<std::uint32_t>(i));
                });
        });
        std::vector<std::uint32_t> suspects;
        for (const std::vector<std::uint32_t>& of_chunk : found) {
            suspects.insert(suspects.end(), of_chunk.begin(), of_chunk.end());
        }
        return suspects;
    }

    /// Calls use(i, hash(i)) for the numbers from `first` to `end`. A table of millions of entries misses the caches,
    /// so the hashes of a batch are computed first, and prefetch(hash) is called for each.
    template <class Hash, class Prefetch, class Use>
    static void for_each_hash(std::size_t first, std::size_t end, const Hash& hash, const Prefetch& prefetch,
                              const Use& use) {
        for (std::size_t begin = first; begin < end; begin += batch) {
            const std::size_t length = std::min(batch, end - begin);
            std::uint64_t hashes[batch];
            for (std::size_t i = 0; i < length; ++i) prefetch(hashes[i] = hash(begin + i));
            for (std::size_t i = 0; i < length; ++i) use(begin + i, hashes[i]);
        }
    }

    [[nodiscard]] std::size_t place_of(std::uint64_t hash) const { return (hash >> 32) & (table_.size() - 1); }

    /// Adds primitive i to the table or, if an equal one is there, to the copies.
    template <class Primitive>
    void add(const std::vector<Primitive>& primitives, const std::uint32_t* material_of, std::uint32_t i,
             std::uint64_t hash) {
        const std::uint32_t material = material_of[i];
        const bool has_textures = !scene_.textures.materials.empty();
        if (may_have_holes(primitives[i], has_textures ? &scene_.textures.materials[material] : nullptr)) return;
        const auto part = static_cast<std::uint32_t>(hash);
        const auto is_like = [&](const Entry& entry) {
            return entry.hash == part && material_of[entry.number] == material &&
                   same_bits(shape_of(primitives[entry.number]), shape_of(primitives[i]));
        };
        std::size_t place = place_of(hash);
        while (table_[place].number != empty && !is_like(table_[place])) place = (place + 1) & (table_.size() - 1);
        if (table_[place].number == empty) {
            table_[place] = {part, i};
        } else {
            copies_.push_back({first_id_ + i, first_id_ + table_[place].number});
        }
    }

    const PreparedScene& scene_;
    std::uint32_t first_id_ = 0;
    std::vector<Entry> table_;
    std::vector<PrimitiveCopy> copies_;
};

/// Removes the elements of copies from an array by primitive. The first element is that of the primitive `first_id`.
template <class T>
void remove(const std::vector<PrimitiveCopy>& copies, std::size_t first_id, std::vector<T>& array) {
    auto copy = std::lower_bound(copies.begin(), copies.end(), first_id,
                                 [](const PrimitiveCopy& c, std::size_t id) { return c.id < id; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < array.size(); ++i) {
        if (copy != copies.end() && copy->id == first_id + i) {
            ++copy;
        } else {
            array[kept++] = array[i];
        }
    }
    array.resize(kept);
}

}  // namespace

std::vector<PrimitiveCopy> find_copies(const PreparedScene& scene) { return Finder(scene).run(); }

PreparedScene without_copies(const PreparedScene& scene) {
    PreparedScene result = scene;
    std::size_t first_id = 0;
#define TANDEM_PRIMITIVE(Type, name, names)       \
    remove(scene.copies, first_id, result.names); \
    first_id += scene.names.size();
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    remove(scene.copies, 0, result.material_of);
    remove(scene.copies, 0, result.node_of);
    const auto before_instances = static_cast<std::uint32_t>(scene.copies.size());
    for (InstancedMesh& mesh : result.instances.meshes) mesh.first_id -= before_instances;
    for (MeshInstance& instance : result.instances.instances) instance.first_id -= before_instances;
    const TracedIds ids(scene.copies);
    for (AreaLight& light : result.area_lights) light.primitive = ids.traced(light.primitive);
    result.copies.clear();
    return result;
}

std::uint32_t TracedIds::traced(std::uint32_t id) const {
    const auto by_id = [](const PrimitiveCopy& copy, std::uint32_t i) { return copy.id < i; };
    auto copy = std::lower_bound(copies_.begin(), copies_.end(), id, by_id);
    if (copy != copies_.end() && copy->id == id) {
        id = copy->of;
        copy = std::lower_bound(copies_.begin(), copies_.end(), id, by_id);
    }
    return id >= first_special_id ? id : id - static_cast<std::uint32_t>(copy - copies_.begin());
}

std::uint32_t TracedIds::of_scene(std::uint32_t traced) const {
    if (traced >= first_special_id) return traced;
    // copies_[k].id - k primitives before copy k are not copies
    std::size_t first = 0, end = copies_.size();
    while (first < end) {
        const std::size_t middle = (first + end) / 2;
        if (copies_[middle].id - middle <= traced) {
            first = middle + 1;
        } else {
            end = middle;
        }
    }
    return traced + static_cast<std::uint32_t>(first);
}

}  // namespace tandem
