// SPDX-License-Identifier: MIT
// Recognises files of other formats by their first bytes, so that an error can name the format.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "mavloom/base/bytes.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::record {

struct ForeignFormat {
    std::string_view name;    // "a ULog of PX4"
    std::string_view advice;  // what to do with such a file
};

// How many bytes of a file `foreign_format` looks at.
inline constexpr std::size_t foreign_format_bytes = 4096;
static_assert(foreign_format_bytes >= 2 * wire::max_frame_length);

// Returns nothing if the bytes may begin a tlog, even a damaged one. `table` is used to check the checksums of frames.
[[nodiscard]] std::optional<ForeignFormat> foreign_format(ByteView first_bytes,
                                                          const wire::MessageTable& table) noexcept;

}  // namespace mavloom::record
