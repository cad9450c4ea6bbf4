// SPDX-License-Identifier: MIT
// The rules: each is a pure function that appends what it finds. Private to module observe.
#pragma once

#include <vector>

#include "mavloom/observe/diagnosis.hpp"

namespace mavloom::observe::rules {

using Findings = std::vector<Finding>;

void find_unheard(const Evidence& evidence, Findings& findings);
void find_unreadable(const Evidence& evidence, Findings& findings);
void find_losses(const Evidence& evidence, Findings& findings);
void find_own_losses(const Evidence& evidence, Findings& findings);
void find_hop_losses(const Evidence& evidence, Findings& findings);
void find_senders(const Evidence& evidence, Findings& findings);
void find_missing_heartbeats(const Evidence& evidence, Findings& findings);
void find_unsigned(const Evidence& evidence, Findings& findings);
void find_clocks(const Evidence& evidence, Findings& findings);
void find_rates(const Evidence& evidence, Findings& findings);
void find_full_links(const Evidence& evidence, Findings& findings);
void find_passages(const Evidence& evidence, Findings& findings);

// The way in which the frames of a sender come. If it is not the usual one, sequence numbers show no loss.
enum class Arrival : std::uint8_t { usual, two_senders, two_links, split, duplicates };
[[nodiscard]] Arrival arrival_of(const Evidence& evidence, std::size_t source, const SenderStream& sender);
[[nodiscard]] const SenderStream* stream_of(const Evidence& evidence, std::size_t source, Source sender);

}  // namespace mavloom::observe::rules
