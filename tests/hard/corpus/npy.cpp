#include "hard/corpus/npy.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <regex>
#include <string_view>
#include <type_traits>

#include "tandem/base/error.h"
#include "tandem/base/whole_file.h"

namespace tandem::hard {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");
constexpr std::string_view magic("\x93NUMPY\x01\x00", 8);
constexpr std::size_t header_start = 10;  // magic, version, length of the header

template <class T>
void write(const std::string& path, const char* type, std::span<const T> numbers, std::size_t columns) {
    const std::size_t rows = numbers.size() / columns;
    const std::string shape = columns == 1 ? fmt::format("({},)", rows) : fmt::format("({}, {})", rows, columns);
    std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, shape);
    // the data starts at a multiple of 64
    header.append(63 - (header_start + header.size()) % 64, ' ');
    header += '\n';
    std::string file(magic);
    file += static_cast<char>(header.size() & 0xFF);
    file += static_cast<char>(header.size() >> 8);
    file += header;
    file.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
    write_file(path, std::string_view(file), Durability::written);
}

/// The numbers of `data` as `Stored`, each as `T`.
template <class Stored, class T>
std::vector<T> convert(std::string_view data) {
    std::vector<T> result(data.size() / sizeof(Stored));
    for (std::size_t i = 0; i < result.size(); ++i) {
        Stored stored;
        std::memcpy(&stored, data.data() + i * sizeof(Stored), sizeof(Stored));
        result[i] = static_cast<T>(stored);
    }
    return result;
}

struct Header {
    std::string type;
    std::string shape;
    std::string_view data;
};

Header read_header(const std::string& path, std::string_view file) {
    const auto fail = [&](const char* what) { throw InputError(fmt::format("{}: {}", path, what)); };
    if (file.size() < header_start || file.substr(0, 7) != magic.substr(0, 7) || file[7] != 0) {
        fail("is not an array in NumPy's format, version 1.0");
    }
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(file[i])); };
    const std::size_t length = byte(8) | byte(9) << 8;
    if (file.size() < header_start + length) fail("ends within its header");
    const std::string text(file.substr(header_start, length));
    static const std::regex member("'(descr|fortran_order|shape)': *('[^']*'|True|False|\\([^)]*\\))");
    Header header;
    header.data = file.substr(header_start + length);
    std::string order;
    for (std::sregex_iterator i(text.begin(), text.end(), member), end; i != end; ++i) {
        ((*i)[1] == "descr" ? header.type : (*i)[1] == "shape" ? header.shape : order) = (*i)[2];
    }
    if (header.type.empty() || header.shape.empty() || order != "False") {
        fail("has a header without 'descr', 'shape' or 'fortran_order': False");
    }
    std::erase(header.shape, ' ');
    return header;
}

}  // namespace

void write_npy(const std::string& path, std::span<const float> numbers, std::size_t columns) {
    write(path, "<f4", numbers, columns);
}
void write_npy(const std::string& path, std::span<const double> numbers) { write(path, "<f8", numbers, 1); }
void write_npy(const std::string& path, std::span<const std::int32_t> numbers) { write(path, "<i4", numbers, 1); }
void write_npy(const std::string& path, std::span<const std::uint8_t> numbers) { write(path, "|u1", numbers, 1); }

template <class T>
std::vector<T> read_npy(const std::string& path, std::size_t rows, std::size_t columns) {
    const Bytes bytes = read_file(path);
    const Header header = read_header(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const std::string shape = columns == 1 ? fmt::format("({},)", rows) : fmt::format("({},{})", rows, columns);
    if (header.shape != shape) throw InputError(fmt::format("{}: is of shape {}, not {}", path, header.shape, shape));
    struct Form {
        const char* type;
        std::size_t size;
        std::vector<T> (*convert)(std::string_view data);
    };
    constexpr bool whole = std::is_integral_v<T>;
    static constexpr Form forms[] = {
        {whole ? "'<i4'" : "'<f4'", 4, convert<std::conditional_t<whole, std::int32_t, float>, T>},
        {whole ? "'<i8'" : "'<f8'", 8, convert<std::conditional_t<whole, std::int64_t, double>, T>},
        {whole ? "'<u4'" : "'<f4'", 4, convert<std::conditional_t<whole, std::uint32_t, float>, T>},
        {whole ? "'|u1'" : "'<f8'", whole ? 1 : 8, convert<std::conditional_t<whole, std::uint8_t, double>, T>}};
    for (const Form& form : forms) {
        if (header.type != form.type) continue;
        if (header.data.size() != rows * columns * form.size) {
            throw InputError(fmt::format("{}: has {} bytes of numbers, not {}", path, header.data.size(),
                                         rows * columns * form.size));
        }
        return form.convert(header.data);
    }
    throw InputError(fmt::format("{}: holds numbers of type {}; write {}", path, header.type,
                                 whole ? "'<i4' (int32)" : "'<f4' (float32)"));
}

template std::vector<double> read_npy<double>(const std::string&, std::size_t, std::size_t);
template std::vector<std::int64_t> read_npy<std::int64_t>(const std::string&, std::size_t, std::size_t);

}  // namespace tandem::hard
