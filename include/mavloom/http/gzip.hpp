// SPDX-License-Identifier: MIT
// Decompresses what gzip compressed, for clients that do not.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mavloom::http {

// Returns the content of one gzip member (RFC 1952). Its header must have no optional parts, as `gzip -n` writes it.
// Returns nothing if the bytes have another form, are cut or are damaged.
[[nodiscard]] std::optional<std::string> gunzip(std::string_view compressed);

}  // namespace mavloom::http
