// SPDX-License-Identifier: MIT
#include "mavloom/route/engine.hpp"

namespace mavloom::route {

std::string_view verdict_name(Verdict verdict) noexcept {
    switch (verdict) {
        case Verdict::forwarded: return "forwarded";
        case Verdict::nowhere: return "nowhere";
        case Verdict::filtered: return "filtered";
        case Verdict::rate_limited: return "rate_limited";
        case Verdict::duplicate: return "duplicate";
        case Verdict::echo: return "echo";
        case Verdict::unknown_target: return "unknown_target";
        case Verdict::consumed: return "consumed";
        case Verdict::tap: return "tap";
        case Verdict::private_link: return "private_link";
        case Verdict::unknown_link: return "unknown_link";
    }
    return "";
}

std::string_view reason_text(Reason reason) noexcept {
    switch (reason) {
        case Reason::sent: return "sent";
        case Reason::tap: return "sent, a tap gets everything";
        case Reason::dropped: return "the frame goes to no link";
        case Reason::ingress: return "it came from this link";
        case Reason::same_group: return "it came from another link of the same group";
        case Reason::source_here: return "its own sender was heard on this link";
        case Reason::other_target: return "its target has no route on this link";
        case Reason::private_link: return "a private link on which the exact target was not heard";
        case Reason::filtered: return "filtered on the way out";
        case Reason::other_member: return "another link of the group carries it";
        case Reason::already_sent: return "it was already sent there when it arrived on another link";
        case Reason::rate_limited: return "over max_rate";
        case Reason::bytes_limited: return "over max_bytes";
    }
    return "";
}

}  // namespace mavloom::route
