#include "tandem/base/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "tandem/base/error.h"

namespace tandem {

namespace {

constexpr std::int64_t most_bytes = std::int64_t{1} << 34;

std::string reason(int error) { return std::generic_category().message(error); }

/// Throws InputError or EnvironmentError, depending on the errno.
bool is_wrong_path(int error) {
    constexpr int wrong[] = {ENOENT, ENOTDIR, EISDIR, EACCES, EPERM, EROFS, ENAMETOOLONG, ELOOP, ENOTEMPTY, EEXIST};
    return std::find(std::begin(wrong), std::end(wrong), error) != std::end(wrong);
}

[[noreturn]] void fail(const char* verb, const std::string& path, int error) {
    const std::string message = fmt::format("cannot {} '{}': {}", verb, path, reason(error));
    if (is_wrong_path(error)) throw InputError(message);
    throw EnvironmentError(message);
}

class Descriptor {
  public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    [[nodiscard]] int number() const { return number_; }
    /// Closes the file. 0, or the errno: some file systems report a failed write only now.
    int close() {
        const int number = std::exchange(number_, -1);
        return number >= 0 && ::close(number) != 0 ? errno : 0;
    }

  private:
    int number_;
};

/// The folder of `path`; "." for a bare name.
std::filesystem::path folder_of(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    return folder.empty() ? "." : folder;
}

/// A name beside `path` that no other thread or process uses.
std::string temporary_name(const std::string& path) {
    static std::atomic<std::uint64_t> count{0};
    const std::string name = std::filesystem::path(path).filename().string();
    return (folder_of(path) / fmt::format(".{}.{}-{}.tmp", name, ::getpid(), count++)).string();
}

/// 0, or the errno.
int write_all(int descriptor, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) return errno;
        if (written > 0) bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return 0;
}

/// Creates the file `name` with the bytes. 0, or the errno; then the file may be incomplete.
int write_new_file(const std::string& name, std::span<const std::byte> bytes, Durability durability) {
    Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.number() < 0) return errno;
    if (const int error = write_all(file.number(), bytes)) return error;
    if (durability == Durability::synced && ::fsync(file.number()) != 0) return errno;
    return file.close();
}

}  // namespace

Bytes read_file(const std::string& path) {
    // O_NONBLOCK: opening a pipe would wait for its other end
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number() < 0) throw InputError(fmt::format("cannot read '{}': {}", path, reason(errno)));
    struct stat status = {};
    if (::fstat(file.number(), &status) != 0)
        throw InputError(fmt::format("cannot read '{}': {}", path, reason(errno)));
    if (!S_ISREG(status.st_mode)) throw InputError(fmt::format("cannot read '{}': it is not a regular file", path));
    if (status.st_size > most_bytes) throw InputError(fmt::format("cannot read '{}': it is larger than 16 GiB", path));
    Bytes bytes(static_cast<std::size_t>(status.st_size));
    std::size_t size = 0;
    while (size < bytes.size()) {
        const ssize_t count = ::read(file.number(), bytes.data() + size, bytes.size() - size);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) throw InputError(fmt::format("cannot read '{}': {}", path, reason(errno)));
        if (count == 0) break;
        size += static_cast<std::size_t>(count);
    }
    bytes.resize(size);
    return bytes;
}

void write_file(const std::string& path, std::span<const std::byte> bytes, Durability durability) {
    const std::string temporary = temporary_name(path);
    int error = write_new_file(temporary, bytes, durability);
    if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
    if (error == 0) return;
    ::unlink(temporary.c_str());
    fail("write", path, error);
}

void write_file(const std::string& path, std::string_view text, Durability durability) {
    write_file(path, std::as_bytes(std::span(text)), durability);
}

void check_can_write(const std::string& path) {
    const std::filesystem::path folder = folder_of(path);
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored)) {
        throw InputError(fmt::format("cannot write '{}': there is no folder '{}'; create it", path, folder.string()));
    }
    if (std::filesystem::is_directory(path, ignored)) fail("write", path, EISDIR);
    if (::access(folder.c_str(), W_OK | X_OK) != 0) fail("write", path, errno);
}

}  // namespace tandem
