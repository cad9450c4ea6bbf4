// SPDX-License-Identifier: MIT
#include "mavloom/web/token.hpp"

#include <fmt/format.h>

#include "mavloom/base/secret_file.hpp"
#include "mavloom/base/text.hpp"

namespace mavloom::web {

namespace {

constexpr std::size_t shortest = 16;
constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";

}  // namespace

SetupResult<std::string> read_token(const std::string& file) {
    if (file.empty()) return std::string();
    auto text = read_secret_file(file, "token file");
    if (!text) return text;
    const auto token = std::string(trimmed(*text));
    if (token.size() >= shortest && token.find_first_not_of(letters) == std::string::npos) return token;
    return setup_error(SetupCode::bad_input,
                       fmt::format("{} has no token of {} or more letters, digits and -._~; this makes one: "
                                   "(umask 077; openssl rand -hex 16 > {})",
                                   file, shortest, file));
}

}  // namespace mavloom::web
