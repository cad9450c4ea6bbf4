// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_map>

#include "layout.hpp"
#include "loader.hpp"
#include "mavloom/base/suggest.hpp"

namespace mavloom::dialect {
namespace {

tl::unexpected<SetupError> conflict(const SourceLocation& location, std::string_view what) {
    return setup_error(SetupCode::bad_input, fmt::format("{}: {}", location.text(), what));
}

bool same(const CommandParam& a, const CommandParam& b) {
    return a.index == b.index && a.label == b.label && a.units == b.units && a.enum_name == b.enum_name &&
           a.default_value == b.default_value && a.minimum == b.minimum && a.maximum == b.maximum &&
           a.increment == b.increment && a.reserved == b.reserved;
}

// Compares two definitions of an entry. A repeated one may omit the parameters.
bool agree(const EntryDefinition& a, const EntryDefinition& b) {
    return a.name == b.name && a.value == b.value &&
           (a.params.empty() || b.params.empty() || std::ranges::equal(a.params, b.params, same));
}

bool same(const FieldDefinition& a, const FieldDefinition& b) {
    const auto& x = a.field;
    const auto& y = b.field;
    return x.name == y.name && x.type == y.type && x.array_length == y.array_length && x.extension == y.extension &&
           x.instance == y.instance && x.bitmask == y.bitmask && x.units == y.units && x.invalid == y.invalid &&
           x.multiplier == y.multiplier && a.enum_name == b.enum_name;
}

bool same(const MessageDefinition& a, const MessageDefinition& b) {
    return a.id == b.id && a.name == b.name &&
           std::ranges::equal(a.fields, b.fields, [](const auto& x, const auto& y) { return same(x, y); });
}

// Merges like mavgen: if the value ranges overlap, renumbers entries of the earlier file that have no explicit value.
// Those up to the later file's highest value get new values above it.
void merge_into(EnumDefinition& earlier, EnumDefinition& later) {
    const bool overlap = !earlier.entries.empty() && !later.entries.empty() && earlier.lowest <= later.highest &&
                         earlier.highest >= later.lowest;
    if (overlap) {
        for (auto& entry : earlier.entries)
            if (!entry.value_is_given && entry.value <= later.highest && later.highest != UINT64_MAX)
                entry.value = ++later.highest;
    }
    earlier.entries.insert(earlier.entries.end(), later.entries.begin(), later.entries.end());
    earlier.bitmask |= later.bitmask;
    if (earlier.deprecated.since.empty()) earlier.deprecated = later.deprecated;
}

class EnumMerge {
public:
    explicit EnumMerge(Records& records) : records_(records) {}

    SetupResult<void> run(std::vector<EnumDefinition>& definitions) {
        std::map<std::string_view, EnumDefinition*> by_name;
        for (auto& definition : definitions) {
            const auto [at, is_new] = by_name.emplace(definition.name, &definition);
            if (!is_new) merge_into(*at->second, definition);
        }
        for (const auto& [name, definition] : by_name)
            if (auto added = add(*definition); !added) return added;
        return {};
    }

private:
    SetupResult<void> add(EnumDefinition& definition) {
        auto entries = distinct(definition);
        if (!entries) return tl::unexpected(std::move(entries.error()));
        std::ranges::sort(*entries, {}, &EnumEntry::value);
        records_.enums.push_back({definition.name, definition.bitmask,
                                  Records::keep(records_.entries, std::move(*entries)), definition.deprecated});
        return {};
    }

    SetupResult<std::vector<EnumEntry>> distinct(EnumDefinition& definition) {
        std::unordered_map<std::string_view, EntryDefinition*> by_name;
        std::unordered_map<std::uint64_t, EntryDefinition*> by_value;
        std::vector<EntryDefinition*> order;
        for (auto& entry : definition.entries) {
            const auto [named, new_name] = by_name.emplace(entry.name, &entry);
            const auto [valued, new_value] = by_value.emplace(entry.value, &entry);
            if (new_name && new_value) {
                order.push_back(&entry);
                continue;
            }
            auto& first = new_name ? *valued->second : *named->second;
            if (!agree(first, entry)) return clash(definition.name, first, entry);
            if (first.params.empty()) first.params = std::move(entry.params);
        }
        std::vector<EnumEntry> entries;
        entries.reserve(order.size());
        for (auto* entry : order)
            entries.push_back({entry->name, entry->value, Records::keep(records_.params, std::move(entry->params)),
                               entry->deprecated});
        return entries;
    }

    static tl::unexpected<SetupError> clash(std::string_view enum_name, const EntryDefinition& first,
                                            const EntryDefinition& second) {
        if (first.name == second.name && first.value == second.value) {
            return conflict(second.location, fmt::format("{} has other parameters at {}; expected the same",
                                                         second.name, first.location.text()));
        }
        return conflict(
            second.location,
            fmt::format("{} = {} in enum {} conflicts with {} = {} at {}; expected one name for each value",
                        second.name, second.value, enum_name, first.name, first.value, first.location.text()));
    }

    Records& records_;
};

class MessageMerge {
public:
    explicit MessageMerge(Records& records) : records_(records) {}

    SetupResult<void> run(const std::vector<MessageDefinition>& definitions) {
        std::map<std::uint32_t, const MessageDefinition*> by_id;
        std::unordered_map<std::string_view, const MessageDefinition*> by_name;
        for (const auto& definition : definitions) {
            const auto* first = by_id.emplace(definition.id, &definition).first->second;
            if (first == &definition) first = by_name.emplace(definition.name, &definition).first->second;
            if (first != &definition && !same(*first, definition)) return clash(*first, definition);
        }
        if (by_id.size() > max_messages) {
            return conflict(definitions.back().location,
                            fmt::format("{} messages; expected at most {}", by_id.size(), max_messages));
        }
        for (const auto& [id, definition] : by_id)
            if (auto added = add(*definition); !added) return added;
        return {};
    }

private:
    static tl::unexpected<SetupError> clash(const MessageDefinition& first, const MessageDefinition& second) {
        if (first.id != second.id) {
            return conflict(second.location, fmt::format("message {} has id {} here and id {} at {}; expected one id",
                                                         second.name, second.id, first.id, first.location.text()));
        }
        if (first.name != second.name) {
            return conflict(second.location, fmt::format("id {} of message {} belongs to {} at {}; expected a free id",
                                                         second.id, second.name, first.name, first.location.text()));
        }
        return conflict(second.location,
                        fmt::format("message {} (id {}) has other content at {}; expected one definition", second.name,
                                    second.id, first.location.text()));
    }

    SetupResult<void> add(const MessageDefinition& definition) {
        std::vector<Field> fields;
        fields.reserve(definition.fields.size());
        for (const auto& written : definition.fields) {
            auto field = resolved(written);
            if (!field) return tl::unexpected(std::move(field.error()));
            fields.push_back(*field);
        }
        const auto wire = lay_out(MessageId{definition.id}, definition.name, fields);
        records_.messages.push_back({definition.name, wire, Records::keep(records_.fields, std::move(fields)),
                                     definition.origin, definition.deprecated});
        return {};
    }

    SetupResult<Field> resolved(const FieldDefinition& written) const {
        Field field = written.field;
        if (written.enum_name.empty()) return field;
        field.enumeration = find_enum_in(records_.enums, written.enum_name);
        if (field.enumeration == nullptr) return unknown_enum(written);
        field.bitmask |= field.enumeration->bitmask;
        return field;
    }

    tl::unexpected<SetupError> unknown_enum(const FieldDefinition& written) const {
        std::vector<std::string_view> names;
        names.reserve(records_.enums.size());
        for (const auto& e : records_.enums) names.push_back(e.name);
        return conflict(written.location,
                        fmt::format("field '{}' names the enum '{}', which no file defines{}; expected an enum",
                                    written.field.name, written.enum_name, did_you_mean(written.enum_name, names)));
    }

    Records& records_;
};

}  // namespace

SetupResult<void> merge(FileDefinitions definitions, Records& records) {
    if (auto merged = EnumMerge(records).run(definitions.enums); !merged) return merged;
    return MessageMerge(records).run(definitions.messages);
}

}  // namespace mavloom::dialect
