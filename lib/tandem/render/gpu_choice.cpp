#include "tandem/render/gpu_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <utility>

#include "tandem/base/error.h"

namespace tandem {

namespace {

constexpr int most_gpus = 1024;

/// The numbers of a list; empty if it is none.
std::vector<int> numbers_in(const std::string& text) {
    std::vector<int> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        int number = 0;
        const auto [stop, error] = std::from_chars(at, end, number);
        if (error != std::errc() || number < 0 || number > most_gpus) return {};
        numbers.push_back(number);
        if (stop == end) return numbers;
        if (*stop != ',') return {};
        at = stop + 1;
    }
}

GpuChoice these(std::vector<int> numbers) {
    std::vector<int> sorted = numbers;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) throw InputError(fmt::format("GPU {} is named twice", *twice));
    const int count = static_cast<int>(numbers.size());
    return {.count = count, .numbers = std::move(numbers)};
}

std::string list_of(const std::vector<std::string>& names) {
    if (names.empty()) return "no GPU";
    std::string text = names.size() == 1 ? "only" : "";
    for (std::size_t i = 0; i < names.size(); ++i) {
        text += fmt::format("{} GPU {} ({})", i == 0 ? "" : i + 1 < names.size() ? "," : " and", i, names[i]);
    }
    return text.starts_with(' ') ? text.substr(1) : text;
}

}  // namespace

GpuChoice parse_gpus(const std::string& text) {
    if (text == "all") return {.count = 0};
    std::vector<int> numbers = numbers_in(text);
    if (numbers.size() > 1) return these(std::move(numbers));
    if (numbers.empty() || numbers.front() == 0) {
        throw InputError(
            fmt::format("GPUs are chosen by 'all', by how many (1 or more), or by a list of their numbers such as 0,1; "
                        "'{}' is something else. A single one is chosen by its number: --backend cuda:0",
                        text));
    }
    return {.count = numbers.front()};
}

GpuChoice parse_gpu_list(const std::string& text) {
    if (text == "all") return {.count = 0};
    std::vector<int> numbers = numbers_in(text);
    if (numbers.empty()) {
        throw InputError(
            fmt::format("'cuda:{}' names no GPU; cuda:1 is GPU 1, cuda:0,1 are two, cuda:all is all", text));
    }
    return these(std::move(numbers));
}

std::vector<int> chosen_gpus(const GpuChoice& choice, const std::vector<std::string>& names) {
    const int present = static_cast<int>(names.size());
    for (const int number : choice.numbers) {
        if (number >= present) {
            throw EnvironmentError(fmt::format("there is no GPU {}; this machine has {}", number, list_of(names)));
        }
    }
    if (!choice.numbers.empty()) return choice.numbers;
    if (choice.count > present || present == 0) {
        throw EnvironmentError(
            fmt::format("{} GPUs are asked for, but this machine has {}", choice.count, list_of(names)));
    }
    std::vector<int> numbers(static_cast<std::size_t>(choice.count == 0 ? present : choice.count));
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

}  // namespace tandem
