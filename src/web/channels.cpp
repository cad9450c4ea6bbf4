// SPDX-License-Identifier: MIT
#include "web/channels.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mavloom/dialect/message_class.hpp"
#include "web/clients/foxglove.hpp"

namespace mavloom::web {

namespace {

std::string topic_of(Source source, std::string_view name) {
    return fmt::format("/{}/{}/{}", source.system.value, source.component.value, name);
}

// Class 0 is for the texts of the protocol, which must not be lost.
Kind make_kind(const dialect::Message& message) {
    const auto message_class = dialect::class_of(message.id(), &message.wire);
    const auto type = message::ros2_type(message);
    return {.message = &message,
            .has_instances = message::instance_field(message) != nullptr,
            .encoder = message::CdrEncoder(message),
            .standard = nullptr,
            .type = type,
            .description = foxglove::description(type, message::ros2msg(message)),
            .block_class = std::max(std::uint8_t{1}, static_cast<std::uint8_t>(message_class)),
            .is_replaceable = message_class == dialect::MessageClass::telemetry &&
                              dialect::meaning_of(message.id()) == dialect::FrameMeaning::latest};
}

bool is_silent(const Channel& channel, MonoTime now) {
    const auto* const latest = channel.latest();
    return latest == nullptr || now - latest->heard >= observe::LatestTable::forgotten_after;
}

void count(observe::TrafficRow& traffic, WallTime time) {
    if (traffic.count != 0) traffic.note_gap(time);
    traffic.count_frame(0, time);
}

}  // namespace

const Kind& Channels::kind_of(const dialect::Message& message) {
    auto& kind = kinds_[message.id()];
    if (kind == nullptr) kind = std::make_unique<Kind>(make_kind(message));
    return *kind;
}

Channel& Channels::append(Source source, const Kind& kind, std::string topic) {
    ++last_id_;
    return all_.emplace(last_id_, Channel{.id = last_id_, .source = source, .kind = kind, .topic = std::move(topic)})
        .first->second;
}

void Channels::add_standard(Channel& channel, const Standard& standard) {
    auto& kind = standard_kinds_[&standard];
    if (!kind) {
        kind = std::make_unique<Kind>(channel.kind);
        kind->standard = &standard;
        kind->type = standard.type;
        kind->description = foxglove::description(standard.type, standard.schema());
    }
    Channel& added = append(channel.source, *kind, topic_of(channel.source, standard.topic));
    added.of = &channel;
    channel.standards.push_back(&added);
}

void Channels::find_other(Channel& standard) const {
    const auto& other = standard.kind.standard->other;
    if (!other || standard.other != nullptr) return;
    const auto at = by_key_.find(Key{*other, standard.source, {}});
    if (at != by_key_.end()) standard.other = at->second;
}

// A message and its standard types have all their channels, or none.
Channel* Channels::add(const Key& key, const Kind& kind, const observe::LatestRow& row) {
    const auto is_of_kind = [&](const Standard& standard) { return standard.from == kind.message->id(); };
    const auto wanted = 1 + static_cast<std::size_t>(std::ranges::count_if(standards(), is_of_kind));
    if (wanted > limit_ - all_.size()) forget_silent(row.heard);
    if (wanted > limit_ - all_.size()) return nullptr;
    auto topic = topic_of(key.source, kind.message->name);
    if (kind.has_instances) topic += "/" + message::text_of(key.instance);
    Channel& added = append(key.source, kind, std::move(topic));
    added.traffic = observe::TrafficRow::begin(row.traffic.link, key.source, key.id, row.traffic.last);
    by_key_.emplace(key, &added);
    for (const auto& standard : standards())
        if (is_of_kind(standard)) add_standard(added, standard);
    return &added;
}

// Searches all, so it does that once a second at most.
void Channels::forget_silent(MonoTime now) {
    if (now < may_forget_at_) return;
    may_forget_at_ = now + std::chrono::seconds(1);
    std::erase_if(by_key_, [&](const auto& entry) {
        auto& channel = *entry.second;
        if (!is_silent(channel, now)) return false;
        channel.is_gone = true;
        for (Channel* const standard : channel.standards) standard->is_gone = true;
        return true;
    });
    for (auto& of : by_row_)
        if (of.channel != nullptr && of.channel->is_gone) of = {};
    for (auto& [id, channel] : all_)
        if (channel.other != nullptr && channel.other->is_gone) channel.other = nullptr;
    std::erase_if(all_, [&](const auto& entry) {
        if (entry.second.is_gone) forgotten_.push_back(entry.first);
        return entry.second.is_gone;
    });
}

Channel* Channels::find_or_add(const observe::LatestRow& row) {
    const Key key{row.traffic.id, row.traffic.source, row.instance().value_or(message::Instance())};
    const auto at = by_key_.find(key);
    return at != by_key_.end() ? at->second : add(key, kind_of(*row.message), row);
}

Channel* Channels::take(const observe::LatestRow& row) {
    if (row.message == nullptr) {
        ++unknown_;
        return nullptr;
    }
    if (by_row_.size() <= row.place) by_row_.resize(row.place + 1u);
    auto& its = by_row_[row.place];
    if (its.born != row.born) its = {row.born, find_or_add(row)};
    else if (its.channel == nullptr && row.heard >= may_forget_at_) its.channel = find_or_add(row);
    if (its.channel == nullptr) {
        ++left_out_;
        return nullptr;
    }
    count(its.channel->traffic, row.traffic.last);
    its.channel->row = &row;
    its.channel->born = row.born;
    for (Channel* const standard : its.channel->standards) find_other(*standard);
    return its.channel;
}

const Channel* Channels::find(const observe::LatestRow& row) const noexcept {
    if (row.place >= by_row_.size() || by_row_[row.place].born != row.born) return nullptr;
    return by_row_[row.place].channel;
}

}  // namespace mavloom::web
