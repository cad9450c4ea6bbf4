// SPDX-License-Identifier: MIT
#include "mavloom/dialect/dialect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <unordered_map>

#include "mavloom/base/suggest.hpp"
#include "records.hpp"

namespace mavloom::dialect {
namespace {

std::vector<wire::MessageInfo> wire_infos(std::span<const Message> messages) {
    std::vector<wire::MessageInfo> infos;
    infos.reserve(messages.size());
    for (const auto& message : messages) infos.push_back(message.wire);
    return infos;
}

template <class Records>
std::vector<std::string_view> names_of(const Records& records) {
    std::vector<std::string_view> names;
    for (const auto& record : records) names.push_back(record.name);
    return names;
}

}  // namespace

const Enum* find_enum_in(std::span<const Enum> sorted, std::string_view name) noexcept {
    const auto found = std::ranges::lower_bound(sorted, name, {}, &Enum::name);
    return found != sorted.end() && found->name == name ? &*found : nullptr;
}

const EnumEntry* Enum::find(std::uint64_t value) const noexcept {
    const auto found = std::ranges::lower_bound(entries, value, {}, &EnumEntry::value);
    return found != entries.end() && found->value == value ? &*found : nullptr;
}

const EnumEntry* Enum::find(std::string_view entry_name) const noexcept {
    const auto found = std::ranges::find(entries, entry_name, &EnumEntry::name);
    return found != entries.end() ? &*found : nullptr;
}

const Field* Message::find(std::string_view field_name) const noexcept {
    const auto found = std::ranges::find(fields, field_name, &Field::name);
    return found != fields.end() ? &*found : nullptr;
}

// The entries of the wire table have the same order as `messages`, so an index into one is valid for the other.
struct Dialect::Index {
    wire::MessageTable table;
    std::unordered_map<std::string_view, const Message*> by_name;

    explicit Index(std::span<const Message> messages) : table(wire_infos(messages)) {
        assert(table.messages().size() == messages.size());
        by_name.reserve(messages.size());
        for (const auto& message : messages) by_name.emplace(message.name, &message);
    }
};

Dialect::Dialect(std::string_view name, std::span<const Message> messages, std::span<const Enum> enums)
    : name_(name), messages_(messages), enums_(enums), index_(std::make_shared<const Index>(messages)) {
    assert(std::ranges::adjacent_find(messages, std::ranges::greater_equal{}, &Message::id) == messages.end());
    assert(std::ranges::is_sorted(enums, {}, &Enum::name));
}

Dialect::Dialect(std::string_view name, std::shared_ptr<const Storage> storage)
    : Dialect(name, storage->messages, storage->enums) {
    storage_ = std::move(storage);
}

const Message* Dialect::find(MessageId id) const noexcept {
    const auto* info = index_->table.find(id);
    return info == nullptr ? nullptr : &messages_[static_cast<std::size_t>(info - index_->table.messages().data())];
}

const Message* Dialect::find(std::string_view message_name) const noexcept {
    const auto found = index_->by_name.find(message_name);
    return found == index_->by_name.end() ? nullptr : found->second;
}

const Enum* Dialect::find_enum(std::string_view enum_name) const noexcept { return find_enum_in(enums_, enum_name); }

const wire::MessageTable& Dialect::wire_table() const noexcept { return index_->table; }

SetupResult<const Message*> Dialect::message(std::string_view message_name) const {
    if (const auto* found = find(message_name)) return found;
    return setup_error(SetupCode::usage, fmt::format("unknown message '{}'{}", message_name,
                                                     did_you_mean(message_name, names_of(messages_))));
}

SetupResult<FieldHandle> Dialect::field(std::string_view message_dot_field) const {
    const auto dot = message_dot_field.find('.');
    if (dot == std::string_view::npos) {
        return setup_error(SetupCode::usage, fmt::format("'{}': expected MESSAGE.field", message_dot_field));
    }
    const auto found = message(message_dot_field.substr(0, dot));
    if (!found) return tl::unexpected(found.error());
    const auto field_name = message_dot_field.substr(dot + 1);
    if (const auto* field = (*found)->find(field_name)) return FieldHandle{*found, field};
    return setup_error(SetupCode::usage, fmt::format("message {} has no field '{}'{}", (*found)->name, field_name,
                                                     did_you_mean(field_name, names_of((*found)->fields))));
}

namespace {

std::vector<EnumEntry> merged_entries(const Enum& base, const Enum& added) {
    std::vector<EnumEntry> entries(added.entries.begin(), added.entries.end());
    for (const auto& entry : base.entries)
        if (added.find(entry.value) == nullptr && added.find(entry.name) == nullptr) entries.push_back(entry);
    std::ranges::sort(entries, {}, &EnumEntry::value);
    return entries;
}

void merge_enums(Records& records, std::span<const Enum> base, std::span<const Enum> added) {
    std::map<std::string_view, Enum> by_name;
    for (const auto& e : base) by_name.emplace(e.name, e);
    for (const auto& e : added) {
        const auto [at, is_new] = by_name.emplace(e.name, e);
        if (is_new) continue;
        at->second.bitmask |= e.bitmask;
        at->second.entries = Records::keep(records.entries, merged_entries(at->second, e));
        if (!e.deprecated.since.empty()) at->second.deprecated = e.deprecated;
    }
    for (const auto& [name, e] : by_name) records.enums.push_back(e);
}

// Returns a copy whose fields point to the merged enums.
Message rebound(Records& records, Message message) {
    std::vector<Field> fields(message.fields.begin(), message.fields.end());
    for (auto& field : fields) {
        if (field.enumeration == nullptr) continue;
        field.enumeration = find_enum_in(records.enums, field.enumeration->name);
        field.bitmask |= field.enumeration->bitmask;
    }
    message.fields = Records::keep(records.fields, std::move(fields));
    return message;
}

}  // namespace

SetupResult<Dialect> Dialect::with(const Dialect& other) const {
    constexpr std::size_t max_messages = 60'000;  // the wire table uses 16-bit indexes
    auto storage = std::make_shared<Storage>();
    storage->kept_alive = {storage_, other.storage_};
    merge_enums(*storage, enums_, other.enums_);
    std::map<std::uint32_t, const Message*> by_id;
    for (const auto& message : messages_)
        if (other.find(message.name) == nullptr) by_id.emplace(message.id().value, &message);
    for (const auto& message : other.messages_) by_id.insert_or_assign(message.id().value, &message);
    if (by_id.size() > max_messages)
        return setup_error(SetupCode::bad_input, fmt::format("{} with {} has {} messages; expected at most {}", name_,
                                                             other.name_, by_id.size(), max_messages));
    for (const auto& [id, message] : by_id) storage->messages.push_back(rebound(*storage, *message));
    const auto name = storage->intern(fmt::format("{}+{}", name_, other.name_));
    return Dialect(name, std::move(storage));
}

}  // namespace mavloom::dialect
