// SPDX-License-Identifier: MIT
// The default dialect, compiled in and read from XML, against pymavlink's generator (tools/make_golden_dialect.py), for
// every message and enum.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {
namespace {

std::string_view type_text(FieldType type) {
    constexpr std::string_view names[] = {"char",    "uint8_t",  "int8_t",  "uint16_t", "int16_t", "uint32_t",
                                          "int32_t", "uint64_t", "int64_t", "float",    "double"};
    return names[static_cast<std::size_t>(type)];
}

void append_message(std::vector<std::string>& lines, const Message& m) {
    lines.push_back(fmt::format("M\t{}\t{}\t{}\t{}\t{}\t{}\t{}", m.id().value, m.name, m.wire.crc_extra,
                                m.wire.min_length, m.wire.max_length, m.wire.target_system_offset,
                                m.wire.target_component_offset));
    std::vector<const Field*> order;
    for (const auto& field : m.fields) order.push_back(&field);
    std::ranges::sort(order, {}, &Field::offset);
    for (const auto* f : order) {
        // The generator keeps the field's own mark only; ours adds that of its enum.
        const bool marked = f->bitmask && (f->enumeration == nullptr || !f->enumeration->bitmask);
        lines.push_back(fmt::format("F\t{}\t{}\t{}\t{}\t{:d}\t{:d}\t{:d}\t{}\t{}", f->name, type_text(f->type),
                                    f->array_length, f->offset, f->extension, f->instance, marked, f->units,
                                    f->enumeration == nullptr ? "" : f->enumeration->name));
    }
}

std::vector<std::string> lines_of(const Dialect& dialect) {
    std::vector<std::string> lines;
    for (const auto& m : dialect.messages()) append_message(lines, m);
    for (const auto& e : dialect.enums()) {
        lines.push_back(fmt::format("E\t{}\t{:d}", e.name, e.bitmask));
        for (const auto& entry : e.entries) lines.push_back(fmt::format("V\t{}\t{}", entry.name, entry.value));
    }
    return lines;
}

std::vector<std::string> golden_lines() {
    std::ifstream file(MAVLOOM_GOLDEN "/dialect_all.tsv");
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
}

void expect_equal(const std::vector<std::string>& actual, const std::vector<std::string>& expected) {
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < actual.size(); ++i) ASSERT_EQ(actual[i], expected[i]) << "line " << i + 1;
}

TEST(DefaultDialect, AgreesWithPymavlinkOnEveryMessageAndEnum) {
    expect_equal(lines_of(default_dialect()), golden_lines());
}

std::string text(const Deprecation& d) { return fmt::format("{} {}", d.since, d.replaced_by); }
std::string text(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : "none"; }

// The facts that pymavlink's generator does not keep, or keeps in another form.
std::vector<std::string> further_lines_of(const Dialect& dialect) {
    std::vector<std::string> lines;
    for (const auto& m : dialect.messages()) {
        lines.push_back(fmt::format("{} {} {}", m.name, m.origin, text(m.deprecated)));
        for (const auto& f : m.fields)
            lines.push_back(fmt::format("{} {} {} {}", f.name, f.invalid, f.multiplier, f.bitmask));
    }
    for (const auto& e : dialect.enums()) {
        lines.push_back(fmt::format("{} {}", e.name, text(e.deprecated)));
        for (const auto& entry : e.entries) {
            lines.push_back(fmt::format("{} {}", entry.name, text(entry.deprecated)));
            for (const auto& p : entry.params)
                lines.push_back(fmt::format("{} {} {} {} {} {} {} {} {}", p.index, p.label, p.units, p.enum_name,
                                            p.default_value, text(p.minimum), text(p.maximum), text(p.increment),
                                            p.reserved));
        }
    }
    return lines;
}

TEST(DefaultDialect, IsWhatTheReaderGivesForTheSameFiles) {
    const auto loaded = Dialect::load(MAVLOOM_GOLDEN "/../../dialects/all.xml");
    ASSERT_TRUE(loaded) << loaded.error().text;
    EXPECT_EQ(loaded->name(), default_dialect().name());
    expect_equal(lines_of(default_dialect()), lines_of(*loaded));
    expect_equal(further_lines_of(default_dialect()), further_lines_of(*loaded));
}

}  // namespace
}  // namespace mavloom::dialect
