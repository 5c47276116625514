/// Arrays in NumPy's .npy format: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html. Little
/// endian, in the order of C, one or two dimensions.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tandem::hard {

/// Writes rows of `columns` numbers; one column is a one-dimensional array. The file is written whole or not at all.
void write_npy(const std::string& path, std::span<const float> numbers, std::size_t columns = 1);
void write_npy(const std::string& path, std::span<const double> numbers);
void write_npy(const std::string& path, std::span<const std::int32_t> numbers);
void write_npy(const std::string& path, std::span<const std::uint8_t> numbers);

/// All numbers of an array of `rows` rows of `columns`, as T, which must hold them exactly: floats of 4 bytes or of 8
/// for double, integers of 4 or 8 bytes, signed or not, for std::int64_t. Throws InputError: "FILE: what".
template <class T>
[[nodiscard]] std::vector<T> read_npy(const std::string& path, std::size_t rows, std::size_t columns = 1);

extern template std::vector<double> read_npy<double>(const std::string&, std::size_t, std::size_t);
extern template std::vector<std::int64_t> read_npy<std::int64_t>(const std::string&, std::size_t, std::size_t);

}  // namespace tandem::hard
