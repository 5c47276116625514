#include "cuda/cubin_facts.h"

#include <elf.h>

#include <cstdint>
#include <cstring>
#include <string>

namespace tandem::cuda {

namespace {

using ByteView = std::span<const std::byte>;

/// A range of the bytes; empty if it would exceed them.
ByteView part(ByteView bytes, std::uint64_t offset, std::uint64_t size) {
    if (offset > bytes.size() || size > bytes.size() - offset) return {};
    return bytes.subspan(offset, size);
}

template <class T>
std::optional<T> read(ByteView bytes, std::uint64_t offset) {
    const ByteView from = part(bytes, offset, sizeof(T));
    if (from.size() != sizeof(T)) return std::nullopt;
    T value;
    std::memcpy(&value, from.data(), sizeof(T));
    return value;
}

/// The text at an offset in a string table.
std::string_view text_at(ByteView table, std::uint64_t offset) {
    if (offset >= table.size()) return {};
    const auto* first = reinterpret_cast<const char*>(table.data()) + offset;
    return {first, ::strnlen(first, table.size() - offset)};
}

class Elf {
  public:
    explicit Elf(ByteView file) : file_(file) {
        const auto header = read<Elf64_Ehdr>(file, 0);
        if (!header || std::memcmp(header->e_ident, ELFMAG, SELFMAG) != 0 || header->e_ident[EI_CLASS] != ELFCLASS64 ||
            header->e_machine != EM_CUDA) {
            return;
        }
        header_ = *header;
        if (const auto names = section(header_.e_shstrndx)) names_ = contents(*names);
    }
    [[nodiscard]] std::optional<Elf64_Shdr> section(std::uint64_t index) const {
        if (index >= header_.e_shnum) return std::nullopt;
        return read<Elf64_Shdr>(file_, header_.e_shoff + index * sizeof(Elf64_Shdr));
    }
    [[nodiscard]] std::optional<Elf64_Shdr> section(std::string_view name) const {
        for (std::uint64_t i = 0; i < header_.e_shnum; ++i) {
            const auto found = section(i);
            if (found && this->name(*found) == name) return found;
        }
        return std::nullopt;
    }
    [[nodiscard]] std::string_view name(const Elf64_Shdr& section) const { return text_at(names_, section.sh_name); }
    [[nodiscard]] ByteView contents(const Elf64_Shdr& section) const {
        return section.sh_type == SHT_NOBITS ? ByteView{} : part(file_, section.sh_offset, section.sh_size);
    }

  private:
    ByteView file_;
    Elf64_Ehdr header_{};
    ByteView names_;
};

/// The name of a symbol, by its index.
std::string_view symbol_name(const Elf& elf, std::uint64_t index) {
    const auto symbols = elf.section(".symtab");
    const auto names = elf.section(".strtab");
    if (!symbols || !names) return {};
    const auto symbol = read<Elf64_Sym>(elf.contents(*symbols), index * sizeof(Elf64_Sym));
    return symbol ? text_at(elf.contents(*names), symbol->st_name) : std::string_view{};
}

/// One entry of .nv.info: how its value is given, what it is, and the bytes or the value itself.
struct Attribute {
    std::uint8_t format;
    std::uint8_t kind;
    std::uint16_t size;
};
constexpr std::uint8_t format_sized = 4;
constexpr std::uint8_t kind_registers = 0x2F;
constexpr std::uint8_t kind_least_stack = 0x12;

/// An attribute of a function: a pair of words, the function's symbol and the value.
std::optional<int> attribute_of(const Elf& elf, std::uint8_t kind, std::string_view function) {
    const auto section = elf.section(".nv.info");
    if (!section) return std::nullopt;
    const ByteView info = elf.contents(*section);
    std::uint64_t at = 0;
    while (const auto attribute = read<Attribute>(info, at)) {
        at += sizeof(Attribute);
        if (attribute->format != format_sized) continue;
        const auto symbol = read<std::uint32_t>(info, at);
        const auto value = read<std::uint32_t>(info, at + sizeof(std::uint32_t));
        if (attribute->kind == kind && symbol && value && symbol_name(elf, *symbol) == function) {
            return static_cast<int>(*value);
        }
        at += attribute->size;
    }
    return std::nullopt;
}

}  // namespace

std::optional<CubinFacts> cubin_facts(std::span<const std::byte> cubin, std::string_view kernel) {
    const Elf elf(cubin);
    const auto code = elf.section(".text." + std::string(kernel));
    const auto registers = attribute_of(elf, kind_registers, kernel);
    if (!code || !registers) return std::nullopt;
    CubinFacts facts;
    facts.registers = *registers;
    facts.stack_bytes = attribute_of(elf, kind_least_stack, kernel).value_or(0);
    facts.code = elf.contents(*code);
    if (facts.code.empty()) return std::nullopt;
    return facts;
}

std::string_view variable_of_zeros(std::span<const std::byte> cubin) {
    const Elf elf(cubin);
    const auto symbols = elf.section(".symtab");
    if (!symbols) return {};
    const ByteView entries = elf.contents(*symbols);
    std::uint64_t index = 0;
    while (const auto symbol = read<Elf64_Sym>(entries, index * sizeof(Elf64_Sym))) {
        const auto section = elf.section(symbol->st_shndx);
        const bool is_variable = ELF64_ST_TYPE(symbol->st_info) == STT_OBJECT;
        if (is_variable && section && elf.name(*section) == ".nv.global") return symbol_name(elf, index);
        ++index;
    }
    return {};
}

}  // namespace tandem::cuda
