// SPDX-License-Identifier: MIT
// Decompresses what gzip compressed, for clients that do not.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mavloom::http {

// The content of one gzip member (RFC 1952) whose header has no optional parts, as `gzip -n` writes it. Nothing if the
// bytes have another form, are cut or are damaged.
[[nodiscard]] std::optional<std::string> gunzip(std::string_view compressed);

}  // namespace mavloom::http
