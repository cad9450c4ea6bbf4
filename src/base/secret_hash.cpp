// SPDX-License-Identifier: MIT
#include "mavloom/base/secret_hash.hpp"

#include <sys/random.h>

#include <array>

namespace mavloom {

SecretHash SecretHash::random() noexcept {
    std::array<std::uint64_t, 2> secret{0x9e3779b97f4a7c15u, 0xd6e8feb86659fd93u};
    (void)!::getrandom(secret.data(), sizeof secret, GRND_NONBLOCK);
    return {secret[0], secret[1]};
}

}  // namespace mavloom
