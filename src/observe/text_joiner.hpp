// SPDX-License-Identifier: MIT
// Joins a text that a sender split over several STATUSTEXTs. Private to module observe.
// Source: MAVLink's common.xml, STATUSTEXT.id and STATUSTEXT.chunk_seq.
#pragma once

#include <string>
#include <string_view>

#include "mavloom/base/ids.hpp"
#include "mavloom/msg/statustext.hpp"

namespace mavloom::observe {

class TextJoiner {
public:
    // Returns whether the message continues the text of the one before it.
    bool add(Source source, const msg::Statustext& part);
    [[nodiscard]] const std::string& text() const noexcept { return text_; }

private:
    static constexpr std::size_t max_size = 512;

    Source source_{};
    std::uint16_t id_ = 0;
    std::uint8_t next_chunk_ = 0;  // 0: none is expected
    std::string text_;
};

}  // namespace mavloom::observe
