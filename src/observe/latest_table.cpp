// SPDX-License-Identifier: MIT
#include "mavloom/observe/latest_table.hpp"

#include <algorithm>
#include <functional>
#include <string_view>
#include <tuple>

#include "mavloom/message/view.hpp"

namespace mavloom::observe {

namespace {

// The instance as a number. Two texts of one message have different ones, up to 2^-64.
std::uint64_t number_of_instance(const dialect::Message& message, const dialect::Field& field, ByteView payload) {
    const message::MessageView view(message, payload);
    if (field.type == dialect::FieldType::char8) return std::hash<std::string_view>{}(view.text(field));
    return view.unsigned_integer(field);
}

void note_jitter(LatestRow& row, Nanoseconds gap) noexcept {
    if (gap < Nanoseconds{}) return;  // the clock was set back
    if (row.traffic.count == 1) {
        row.usual_gap = gap;
        return;
    }
    const auto difference = gap - row.usual_gap;
    row.jitter += (std::chrono::abs(difference) - row.jitter) / 16;
    row.usual_gap += difference / 16;
}

void count(LatestRow& row, const Heard& heard) noexcept {
    if (row.traffic.count != 0) {
        note_jitter(row, heard.time - row.traffic.last);
        row.traffic.note_gap(heard.time);
    }
    row.traffic.count_frame(heard.frame.size(), heard.time);
    row.link->bytes += heard.frame.size();
    row.heard = heard.now;
    const auto payload = heard.frame.payload();
    row.payload_size = static_cast<std::uint8_t>(payload.size());
    std::ranges::copy(payload, row.payload_bytes.begin());
}

bool is_of(const LatestRow& row, const Heard& heard) {
    const auto& frame = heard.frame;
    const auto& its = row.traffic;
    if (row.born == 0 || its.id != frame.id() || its.source != frame.source() || its.link != heard.link) return false;
    return row.instance_field == nullptr ||
           row.instance_number == number_of_instance(*row.message, *row.instance_field, frame.payload());
}

auto order_of(const LatestRow& row) {
    const auto& its = row.traffic;
    return std::tuple(its.link, its.source, its.id, row.instance());
}

}  // namespace

std::optional<message::Instance> LatestRow::instance() const {
    if (instance_field == nullptr) return std::nullopt;
    return message::instance_of(*message, *instance_field, payload());
}

std::optional<Nanoseconds> LatestRow::silent_after() const noexcept {
    constexpr Nanoseconds least = std::chrono::seconds{10};
    constexpr std::uint64_t least_frames = 5;
    const bool is_steady = traffic.count >= least_frames && traffic.last - traffic.first >= least &&
                           jitter < usual_gap / 2;
    if (!is_steady) return std::nullopt;
    return std::max(silence, 3 * usual_gap);
}

double LatestRow::share() const noexcept {
    return link->bytes == 0 ? 0 : static_cast<double>(traffic.bytes) / static_cast<double>(link->bytes);
}

LatestTable::LatestTable(const dialect::Dialect& dialect, WhenFull when_full, std::size_t limit)
    : dialect_(dialect), when_full_(when_full), limit_(limit) {
    for (const auto& message : dialect.messages()) instance_fields_.push_back(message::instance_field(message));
}

const dialect::Field* LatestTable::instance_field_of(const dialect::Message* message) const noexcept {
    if (message == nullptr) return nullptr;
    return instance_fields_[static_cast<std::size_t>(message - dialect_.messages().data())];
}

LatestRow*& LatestTable::recent(LinkId link, const wire::FrameView& frame) noexcept {
    const auto source = frame.source();
    const auto mixed = (frame.id().value * 257u + source.system.value * 65537u + source.component.value) ^ link.value;
    return recent_[(mixed * 0x9e3779b1u >> 16) % recent_rows];
}

LatestRow* LatestTable::add(const Heard& heard) {
    ++frames_;
    auto*& row = recent(heard.link, heard.frame);
    if (row == nullptr || !is_of(*row, heard)) row = find_or_add(heard);
    if (row == nullptr) {
        ++unlisted_;
        return nullptr;
    }
    row->number = frames_;
    count(*row, heard);
    return row;
}

LatestRow* LatestTable::find_or_add(const Heard& heard) {
    const auto& frame = heard.frame;
    const auto* const message = dialect_.find(frame.id());
    const auto* const field = instance_field_of(message);
    const auto source = frame.source();
    const Key key{
        heard.link.value,
        std::uint64_t{frame.id().value} << 16 | std::uint64_t{source.system.value} << 8 | source.component.value,
        field == nullptr ? 0 : number_of_instance(*message, *field, frame.payload())};
    const auto at = by_key_.find(key);
    return at != by_key_.end() ? at->second : add_row(key, heard, message);
}

LatestRow* LatestTable::add_row(const Key& key, const Heard& heard, const dialect::Message* message) {
    auto* const row = free_row(heard.now);
    if (row == nullptr) return nullptr;
    auto& link = links_.try_emplace(heard.link).first->second;
    if (link.name.empty()) link.name = heard.link_name;
    ++link.rows;
    const auto place = row->place;
    *row = {.traffic = TrafficRow::begin(heard.link, heard.frame.source(), heard.frame.id(), heard.time),
            .message = message,
            .instance_field = instance_field_of(message),
            .instance_number = key.instance,
            .link = &link,
            .born = frames_,
            .place = place};
    by_key_.emplace(key, row);
    return row;
}

LatestRow* LatestTable::free_row(MonoTime now) {
    if (free_.empty() && rows_.size() == limit_) forget_silent(now);
    if (!free_.empty()) {
        auto* const row = free_.back();
        free_.pop_back();
        return row;
    }
    if (rows_.size() == limit_) return nullptr;
    auto& row = rows_.emplace_back();
    row.place = static_cast<std::uint32_t>(rows_.size() - 1);
    return &row;
}

// Searches all rows, so it does that once a second at most.
void LatestTable::forget_silent(MonoTime now) {
    if (when_full_ == WhenFull::counts || now < may_forget_at_) return;
    may_forget_at_ = now + std::chrono::seconds(1);
    std::erase_if(by_key_, [&](const auto& entry) {
        auto* const row = entry.second;
        if (now - row->heard < forgotten_after) return false;
        row->born = 0;
        --row->link->rows;
        free_.push_back(row);
        return true;
    });
    std::erase_if(links_, [](const auto& entry) { return entry.second.rows == 0; });
}

std::vector<const LatestRow*> LatestTable::sorted() const {
    std::vector<const LatestRow*> all;
    for (const auto& row : rows_)
        if (row.born != 0) all.push_back(&row);
    std::ranges::sort(all, {}, [](const LatestRow* row) { return order_of(*row); });
    return all;
}

}  // namespace mavloom::observe
