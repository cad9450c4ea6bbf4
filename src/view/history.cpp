// SPDX-License-Identifier: MIT
#include "mavloom/view/history.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "mavloom/message/format.hpp"

namespace mavloom::view {

RowKey key_of(const observe::LatestRow& row) noexcept {
    return {row.traffic.link, row.traffic.source, row.traffic.id, row.instance_number};
}

void History::watch(const std::optional<RowKey>& key) {
    if (key == watched_) return;
    watched_ = key;
    kept_.clear();
}

void History::keep(const observe::LatestRow& row) {
    message_ = row.message;
    const auto time = row.traffic.last;
    for (; !kept_.empty() && (kept_.size() == max_payloads || time - kept_.front().time > window); ++dropped_)
        kept_.pop_front();
    kept_.push_back({time, row.payload_size, row.payload_bytes});
}

// Steps are powers of two, and count all payloads: the same ones are chosen again when others were added.
std::vector<Point> History::points(const Number& number, WallTime now, std::size_t most) const {
    std::vector<Point> all;
    const auto step = std::bit_ceil((kept_.size() + most - 1) / most);
    for (auto at = (step - dropped_ % step) % step; at < kept_.size(); at += step) {
        const auto& kept = kept_[at];
        if (now - kept.time > window) continue;
        const message::MessageView view(*message_, ByteView(kept.bytes).first(kept.size));
        const auto value = message::scaled_number(view, *number.field, number.element);
        if (std::isfinite(value)) all.push_back({kept.time, value});
    }
    return all;
}

}  // namespace mavloom::view
