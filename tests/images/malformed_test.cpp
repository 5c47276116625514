/// Files that are cut off, forged or damaged: one InputError, never a crash or a huge allocation.
#include <gtest/gtest.h>

#include <functional>

#include "images/sample_images.h"
#include "support/peak_memory.h"
#include "support/temporary_folder.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/images/image_io.h"

namespace tandem {
namespace {

using namespace test;

std::string ppm_error(std::string_view file) {
    return thrown_message<InputError>([&] { (void)decode_ppm(bytes_of(file), "the file"); });
}

std::string pfm_error(std::string_view file) {
    return thrown_message<InputError>([&] { (void)decode_pfm(bytes_of(file), "the file"); });
}

TEST(MalformedPpm, SaysWhatIsWrong) {
    using Case = std::pair<const char*, const char*>;
    for (const auto& [file, reason] : {Case{"P3", "header is cut off"},
                                       Case{"P3\n1", "header is cut off"},
                                       Case{"P3\n1 1\n255", "header is cut off"},
                                       Case{"P3\n1 1\n255 # no end", "pixel 0"},
                                       Case{"P5\n1 1\n255\nxxx", "P3 or P6"},
                                       Case{"P3\nx 1\n255\n", "width"},
                                       Case{"P3\n-1 1\n255\n", "width"},
                                       Case{"P3\n1 1e3\n255\n", "height"},
                                       Case{"P3\n0 1\n255\n0 0 0", "0 x 1"},
                                       Case{"P3\n1 1\n0\n0 0 0", "largest value is 0"},
                                       Case{"P3\n1 1\n65536\n0 0 0", "largest value is 65536"},
                                       Case{"P3\n99999999999999999999 1\n255\n", "width"},
                                       Case{"P6\n65536 65536\n255\n", "65536 x 65536"},
                                       Case{"P6\n65536 16384\n255\nabc", "only 3 exist"},
                                       Case{"P3\n65536 16384\n255\n1 2 3", "only 5 exist"},
                                       Case{"P6\n1 1\n255\nab", "cut off"},
                                       Case{"P6\n1 1\n256\nabcde", "cut off"},
                                       Case{"P3\n1 1\n255\n1 2 ", "cut off"},
                                       Case{"P3\n1 1\n255\n1 2    ", "pixel 0"},
                                       Case{"P3\n1 1\n255\n1 2 256", "pixel 0"},
                                       Case{"P3\n1 1\n255\n1 2 -3", "pixel 0"},
                                       Case{"P3\n1 1\n255\n1 2 3x", "pixel 0"},
                                       Case{"P6\n1 1\n100\n\x01\x02\x7f", "pixel 0"},
                                       Case{"P3\n# tandem:seed: many\n1 1\n255\n1 2 3", "tandem:seed"}}) {
        EXPECT_NE(ppm_error(file).find(reason), std::string::npos) << file << " gives: " << ppm_error(file);
    }
}

TEST(MalformedPfm, SaysWhatIsWrong) {
    using Case = std::pair<const char*, const char*>;
    for (const auto& [file, reason] :
         {Case{"PF\n1 1\n", "cut off"}, Case{"PX\n1 1\n-1\n", "PF or Pf"}, Case{"PF\n1 1\n0\n", "scale"},
          Case{"PF\n1 1\nnan\n", "scale"}, Case{"PF\n1 1\n1e999\n", "scale"}, Case{"PF\n1 1\nbig\n", "scale"},
          Case{"PF\n1 1\n-1.0\n12345678901", "only 11 exist"}, Case{"Pf\n1 1\n-1.0\n123", "only 3 exist"},
          Case{"PF\n65536 16384\n-1.0\n", "only 0 exist"}, Case{"PF\n65537 1\n-1.0\n", "65537 x 1"}}) {
        EXPECT_NE(pfm_error(file).find(reason), std::string::npos) << file << " gives: " << pfm_error(file);
    }
}

TEST(MalformedPng, AForgedSizeAllocatesNothing) {
    // the header of a 1 x 1 image made to claim 65535 x 16384 pixels; the checksum is mended
    Bytes bytes = encode_png(ByteImage{1, 1, {1, 2, 3}}, {}, 1);
    const std::uint8_t forged[] = {0, 0, 0xFF, 0xFF, 0, 0, 0x40, 0};
    std::memcpy(&bytes[16], forged, sizeof(forged));
    std::uint32_t crc = ~0U;
    for (std::size_t i = 12; i < 29; ++i) {
        crc ^= std::to_integer<std::uint32_t>(bytes[i]);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xEDB88320U & (~(crc & 1) + 1));
    }
    crc = __builtin_bswap32(~crc);
    std::memcpy(&bytes[29], &crc, sizeof(crc));
    const auto message = thrown_message<InputError>([&] { (void)decode_png(bytes, "forged.png"); });
    EXPECT_NE(message.find("forged.png"), std::string::npos);
    EXPECT_NE(message.find("exist"), std::string::npos) << message;
}

TEST(MalformedFile, OfNoKnownKindIsNamed) {
    const TemporaryFolder folder;
    for (const char* content : {"", "P", "GIF89a", "\x89PNG"}) {
        const std::string path = folder.file("a.png");
        write_file(path, content);
        const auto message = thrown_message<InputError>([&] { (void)read_image(path); });
        EXPECT_NE(message.find(path), std::string::npos) << content;
    }
}

struct Kind {
    const char* name;
    std::function<Bytes()> encode;
    std::function<DecodedImage(const Bytes&)> decode;
};

const FloatImage small_picture = sample_floats(9, 7);

std::vector<Kind> kinds() {
    const auto metadata = sample_metadata(9, 7);
    const ByteImage bytes = sample_bytes(9, 7);
    return {
        {"P3", [=] { return encode_ppm_text(bytes, metadata); }, [](const Bytes& b) { return decode_ppm(b, "x"); }},
            {"P6", [=] { return encode_ppm(bytes, metadata); }, [](const Bytes& b) { return decode_ppm(b, "x"); }},
            {"PFM", [] { return encode_pfm(small_picture); }, [](const Bytes& b) { return decode_pfm(b, "x"); }},
            {"PNG", [=] { return encode_png(bytes, metadata, 1); }, [](const Bytes& b) { return decode_png(b, "x"); }},
#if TANDEM_HAS_EXR
            {"EXR", [=] { return encode_exr(small_picture, metadata); },
             [](const Bytes& b) { return decode_exr(b, "x"); }},
#endif
    };
}

TEST(MalformedFile, CutOffAnywhereIsAnInputError) {
    for (const Kind& kind : kinds()) {
        const Bytes whole = kind.encode();
        // the last value of a P3 may lose its last digits and its line end, and is a number still
        const std::size_t optional_tail = kind.name == std::string_view("P3") ? 4 : 0;
        for (std::size_t size = 0; size + optional_tail < whole.size(); ++size) {
            const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
            EXPECT_THROW((void)kind.decode(part), InputError) << kind.name << " cut after " << size << " bytes";
        }
    }
}

TEST(MalformedFile, DamagedBytesGiveAnImageOrAnInputError) {
    const long before = peak_memory();
    for (const Kind& kind : kinds()) {
        const Bytes whole = kind.encode();
        for (unsigned int seed = 0; seed < 400; ++seed) {
            std::mt19937 random(seed);
            Bytes damaged = whole;
            for (unsigned int count = 1 + random() % 8; count > 0; --count) {
                // the header deserves half of the hits
                const std::size_t range = random() % 2 == 0 ? std::min<std::size_t>(64, whole.size()) : whole.size();
                damaged[random() % range] = static_cast<std::byte>(random() & 0xFFU);
            }
            try {
                const DecodedImage decoded = kind.decode(damaged);
                ASSERT_EQ(decoded.image.pixels.size(), pixel_count(decoded.image)) << kind.name << ", seed " << seed;
            } catch (const InputError&) {
            } catch (const std::exception& other) {
                ADD_FAILURE() << kind.name << ", seed " << seed << ": " << other.what();
            }
        }
    }
    EXPECT_LT(peak_memory() - before, 512) << "some file made its reader allocate hundreds of MiB";
}

}  // namespace
}  // namespace tandem
