// SPDX-License-Identifier: MIT
#include "simserve/input_replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace mavloom::simserve {

SetupResult<void> InputReplay::open(const std::filesystem::path& path, const wire::MessageTable& table,
                                    WallTime utc_at_start) {
    auto opened = record::TlogReader::open(path, table);
    if (!opened) return tl::unexpected(std::move(opened.error()));
    reader_.emplace(std::move(*opened));
    utc_at_start_ = utc_at_start;
    advance();
    if (error_) return tl::unexpected(*error_);
    if (next_) return {};
    return setup_error(
        SetupCode::bad_input,
        fmt::format("{} has no frames: no client sent anything in that session, or it is not whole", path.string()));
}

void InputReplay::advance() {
    next_.reset();
    due_ = sim::FlightTime::max();
    const auto record = reader_->next();
    if (record) {
        ++frames_;
        next_ = *record;
        due_ = std::max(sim::FlightTime{record->time - utc_at_start_}, sim::FlightTime{});
    } else if (record.error() == record::TlogReader::Stop::failed) {
        error_ = reader_->error();
    } else if (reader_->found_no_record()) {
        error_ = reader_->no_record_error();
    }
}

LinkId InputReplay::link_of(Source source) const {
    const auto known = links_.find(source);
    return known == links_.end() ? LinkId{} : known->second;
}

bool InputReplay::owns(LinkId link) const noexcept {
    return std::ranges::any_of(links_, [&](const auto& known) { return known.second == link; });
}

}  // namespace mavloom::simserve
