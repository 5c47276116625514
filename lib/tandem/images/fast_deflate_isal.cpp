#include <fmt/format.h>
#include <immintrin.h>
#include <isa-l/igzip_lib.h>

#include <array>
#include <stdexcept>
#include <vector>

#include "tandem/images/fast_deflate.h"

namespace tandem {

namespace {

/// Clears the upper halves of the AVX registers at the end of a scope. ISA-L leaves numbers in them, and until they are
/// cleared, code for SSE is up to 40 times slower on this thread (docs/performance/program.md).
struct UpperHalves {
    [[gnu::target("avx")]] static void clear() { _mm256_zeroupper(); }

    UpperHalves() = default;
    UpperHalves(const UpperHalves&) = delete;
    UpperHalves& operator=(const UpperHalves&) = delete;
    ~UpperHalves() {
        if (__builtin_cpu_supports("avx")) clear();
    }
};

}  // namespace

struct FastDeflate::State {
    isal_zstream stream;  // set by isal_deflate_init()
    std::array<std::uint8_t, ISAL_DEF_LVL1_DEFAULT> level_memory;
    std::vector<std::uint8_t> ready = std::vector<std::uint8_t>(1 << 16);
};

bool FastDeflate::is_available() { return true; }

FastDeflate::FastDeflate() : state_(new State) { begin(); }

FastDeflate::~FastDeflate() = default;

void FastDeflate::begin() {
    isal_zstream& stream = state_->stream;
    isal_deflate_init(&stream);
    stream.gzip_flag = IGZIP_DEFLATE;
    stream.level = 1;
    stream.level_buf = state_->level_memory.data();
    stream.level_buf_size = static_cast<std::uint32_t>(state_->level_memory.size());
}

std::span<const std::uint8_t> FastDeflate::compress(std::span<const std::uint8_t> bytes, Then then) {
    const UpperHalves cleared_at_the_end;
    isal_zstream& stream = state_->stream;
    std::vector<std::uint8_t>& ready = state_->ready;
    stream.next_in = const_cast<std::uint8_t*>(bytes.data());  // ISA-L only reads it
    stream.avail_in = static_cast<std::uint32_t>(bytes.size());
    stream.end_of_stream = then == Then::end ? 1 : 0;
    stream.flush = then == Then::piece ? FULL_FLUSH : NO_FLUSH;
    std::size_t size = 0;
    while (true) {
        stream.next_out = ready.data() + size;
        stream.avail_out = static_cast<std::uint32_t>(ready.size() - size);
        if (const int error = isal_deflate(&stream); error != COMP_OK) {
            throw std::runtime_error(fmt::format("ISA-L cannot compress: error {}", error));
        }
        size = ready.size() - stream.avail_out;
        if (stream.avail_out > 0) return {ready.data(), size};
        ready.resize(2 * ready.size());
    }
}

std::uint32_t FastDeflate::adler32(std::uint32_t before, std::span<const std::uint8_t> bytes) {
    const UpperHalves cleared_at_the_end;
    return isal_adler32(before, bytes.data(), bytes.size());
}

}  // namespace tandem
