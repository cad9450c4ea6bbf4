// SPDX-License-Identifier: MIT
// The different texts of severity WARNING and above. Private to module observe.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "mavloom/observe/summary.hpp"
#include "observe/text_joiner.hpp"

namespace mavloom::observe {

// A text that may continue in the sender's next message.
struct OpenText {
    TextJoiner joiner{};
    std::uint8_t severity = 0;
    When when{};         // of its first part
    std::string text{};  // empty: there is none
};

class TextLog {
public:
    // Returns false if there was no room.
    [[nodiscard]] bool add(Source source, const OpenText& text);
    [[nodiscard]] const std::vector<TextSummary>& texts() const noexcept { return texts_; }

private:
    std::vector<TextSummary> texts_;
    std::unordered_map<std::string, std::size_t> places_;  // by sender, severity and text
};

}  // namespace mavloom::observe
