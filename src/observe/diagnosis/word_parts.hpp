// SPDX-License-Identifier: MIT
// Parts that the words of several findings share. Private to module observe.
#pragma once

#include <string>
#include <string_view>

#include "mavloom/observe/diagnosis.hpp"

namespace mavloom::observe::words {

[[nodiscard]] std::string percent(double ratio);                                 // "3.1 %"
[[nodiscard]] std::string hertz(double hz);                                      // "4.9 Hz"
[[nodiscard]] std::string message_name(const Evidence& evidence, MessageId id);  // "ATTITUDE", "#12345"
// How a ground station sees it.
[[nodiscard]] std::string shown_loss(double loss);

// A finding about a source, a sender, or a sender on a link.
[[nodiscard]] Finding of_source(std::string_view id, Finding::Severity severity, const Listened& source);
[[nodiscard]] Finding of_sender(std::string_view id, Finding::Severity severity, Source sender,
                                const std::string& where);
[[nodiscard]] Finding of_link(std::string_view id, Finding::Severity severity, const Evidence& evidence, LinkId link,
                              Source sender);

}  // namespace mavloom::observe::words
