/// SHA-256, computed by OpenSSL's libcrypto.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace tandem {

class Sha256 {
  public:
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;

    void update(const void* data, std::size_t bytes);
    /// Adds the object representation of a plain value.
    template <class T>
    void update_value(const T& value) {
        update(&value, sizeof(value));
    }
    /// The digest in hexadecimal; call once.
    [[nodiscard]] std::string hex();

  private:
    struct Context;
    std::unique_ptr<Context> context_;
};

}  // namespace tandem
