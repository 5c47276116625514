/// Thousands of broken files, always the same ones: each gives a scene or an InputError, quickly and in little memory.
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <new>
#include <random>

#include "gltf/files.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/image_codecs.h"

namespace {

/// Larger requests fail while a fuzz test runs: they would be forged counts. The largest file here has 16 KB.
constexpr std::size_t most_bytes_at_once = std::size_t{64} << 20;
thread_local bool is_guarded = false;

void* allocate(std::size_t bytes) {
    if (is_guarded && bytes > most_bytes_at_once) throw std::bad_alloc();
    void* memory = std::malloc(bytes == 0 ? 1 : bytes);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

}  // namespace

// The whole program's: allocations of the JSON parser come here as well.
void* operator new(std::size_t bytes) { return allocate(bytes); }
void* operator new[](std::size_t bytes) { return allocate(bytes); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return std::malloc(bytes == 0 ? 1 : bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace tandem {
namespace {

/// Deterministic on every platform: the standard fixes std::mt19937's numbers, but not its distributions'.
class Mutator {
  public:
    explicit Mutator(std::uint32_t seed) : random_(seed) {}

    std::string mutate(std::string bytes) {
        for (std::size_t i = 0, count = 1 + below(4); i < count; ++i) mutate_once(bytes);
        return bytes;
    }

  private:
    std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }

    void mutate_once(std::string& bytes) {
        static const std::string tokens[] = {"-1",   "0",   "1e308", "4294967295",   "9007199254740991",
                                             "null", "[]",  "{}",    "true",         "\"\"",
                                             "[[[[", "1.5", "NaN",   "\"../x\"",     "65536",
                                             ":",    ",",   "}",     "\"children\"", "1e999"};
        const std::size_t at = below(bytes.size());
        const std::size_t length = 1 + below(12);
        switch (below(8)) {
            case 0:  // flip a bit
                if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
                return;
            case 1:  // another byte
                if (!bytes.empty()) bytes[at] = static_cast<char>(below(256));
                return;
            case 2:
                bytes.resize(at);
                return;
            case 3:
                bytes.erase(at, length);
                return;
            case 4:  // splice a part of it elsewhere
                bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(64)));
                return;
            case 5:
                bytes.insert(at, tokens[below(std::size(tokens))]);
                return;
            default:
                replace_number(bytes, at, tokens[below(std::size(tokens))]);
                return;
        }
    }

    /// The next number of the JSON, if there is one: the mutation that gets deepest into the importer.
    static void replace_number(std::string& bytes, std::size_t at, const std::string& token) {
        const std::size_t start = bytes.find_first_of("0123456789", at);
        if (start == std::string::npos) return;
        std::size_t end = bytes.find_first_not_of("0123456789.e+-", start);
        if (end == std::string::npos) end = bytes.size();
        bytes.replace(start, end - start, token);
    }

    std::mt19937 random_;
};

class Fuzz : public test::GltfFiles {
  protected:
    void run(const std::string& bytes, const std::string& extension, std::uint32_t count) {
        for (std::uint32_t seed = 0; seed < count; ++seed) {
            const auto file = write("fuzz" + extension, Mutator(seed).mutate(bytes));
            // a crash leaves no message, so the reproducer is on record before
            RecordProperty("seed", static_cast<int>(seed));
            const std::string outcome = outcome_of(file);
            ASSERT_EQ(outcome, "") << "seed " << seed << " of " << extension << ": Mutator(" << seed << ")";
            ++(was_scene_ ? scenes_ : errors_);
        }
        // a fuzzer whose every file fails at the first brace tests nothing
        EXPECT_GT(scenes_, count / 50);
        EXPECT_GT(errors_, count / 4);
    }

  private:
    std::string outcome_of(const std::filesystem::path& file) {
        is_guarded = true;
        std::string outcome;
        try {
            was_scene_ = false;
            const ImportResult result = import_gltf(file);
            was_scene_ = true;
            (void)prepare(result.scene);
        } catch (const InputError&) {
        } catch (const std::exception& error) {
            outcome = error.what();
        }
        is_guarded = false;
        return outcome;
    }

    bool was_scene_ = false;
    std::uint32_t scenes_ = 0;
    std::uint32_t errors_ = 0;
};

TEST_F(Fuzz, PaperScene) {
    run(test::read_bytes(std::string(TANDEM_SOURCE_DIR) + "/assets/scenes/paper.gltf"), ".gltf", 3000);
}

TEST_F(Fuzz, CompactText) { run(test::Json::parse(test::rich_file().text()).dump(), ".gltf", 3000); }

TEST_F(Fuzz, Meshes) { run(test::mesh_file().glb(), ".glb", 3000); }

TEST_F(Fuzz, Textures) {
    test::TestFile file = test::small_file();
    const Bytes png = encode_png(ByteImage{2, 1, {255, 0, 0, 0, 188, 255}}, {}, 1);
    const std::string text(reinterpret_cast<const char*>(png.data()), png.size());
    const std::size_t accessor = file.add_bytes("SCALAR", 5121, png.size(), text);
    file.json["images"] = {{{"mimeType", "image/png"}, {"bufferView", file.json["accessors"][accessor]["bufferView"]}}};
    file.json["samplers"] = {{{"wrapS", 33071}, {"magFilter", 9728}}};
    file.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    const test::Json info = {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}};
    file.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", info}};
    file.json["materials"][0]["normalTexture"] = info;
    file.json["materials"][0]["alphaMode"] = "MASK";
    run(file.glb(), ".glb", 3000);
}

TEST_F(Fuzz, Binary) { run(test::rich_file().glb(), ".glb", 3000); }

}  // namespace
}  // namespace tandem
