#include "tandem/base/sha256.h"

#include <openssl/evp.h>

#include <stdexcept>

namespace tandem {

struct Sha256::Context {
    EVP_MD_CTX* handle = EVP_MD_CTX_new();
    ~Context() { EVP_MD_CTX_free(handle); }
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
    if (context_->handle == nullptr || EVP_DigestInit_ex(context_->handle, EVP_sha256(), nullptr) != 1) {
        throw std::runtime_error("libcrypto failed to start a SHA-256 digest");
    }
}

Sha256::~Sha256() = default;

void Sha256::update(const void* data, std::size_t bytes) {
    if (EVP_DigestUpdate(context_->handle, data, bytes) != 1)
        throw std::runtime_error("libcrypto failed to update a SHA-256 digest");
}

std::string Sha256::hex() {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    if (EVP_DigestFinal_ex(context_->handle, digest, &size) != 1)
        throw std::runtime_error("libcrypto failed to finish a SHA-256 digest");
    static constexpr char digits[] = "0123456789abcdef";
    std::string text;
    for (unsigned int i = 0; i < size; ++i) {
        text += digits[digest[i] >> 4];
        text += digits[digest[i] & 15];
    }
    return text;
}

}  // namespace tandem
