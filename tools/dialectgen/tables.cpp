// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "generate.hpp"
#include "output.hpp"

namespace mavloom::dialectgen {
namespace {

using dialect::CommandParam;
using dialect::Deprecation;
using dialect::Dialect;
using dialect::Field;
using dialect::FieldType;

std::string text(std::string_view value) {
    return value.empty() ? "{}" : fmt::format("{{{}, {}}}", literal(value), value.size());
}

std::string text(const Deprecation& deprecated) {
    if (deprecated.since.empty()) return "{}";
    return fmt::format("{{{}, {}}}", text(deprecated.since), text(deprecated.replaced_by));
}

std::string text(const std::optional<double>& value) { return value ? fmt::format("{:#}", *value) : "{}"; }

std::string_view text(FieldType type) {
    constexpr std::string_view names[] = {"char8", "u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "f32", "f64"};
    return names[static_cast<std::size_t>(type)];
}

std::string text(const CommandParam& p) {
    return fmt::format("{{{}, {}, {}, {}, {}, {}, {}, {}, {}}}", p.index, text(p.label), text(p.units),
                       text(p.enum_name), text(p.default_value), text(p.minimum), text(p.maximum), text(p.increment),
                       p.reserved);
}

class TableWriter {
public:
    TableWriter(const Dialect& dialect, const Options& options) : dialect_(dialect), options_(options) {
        tables_ = options.is_builtin ? "mavloom::dialect::builtin" : options.cpp_namespace + "::tables";
    }

    SetupResult<void> write() const {
        const std::pair<const char*, std::string> files[] = {
            {"tables.hpp", declarations()}, {"enums.cpp", enums()}, {"messages.cpp", messages()}};
        for (const auto& [name, content] : files)
            if (auto written = write_file(options_.out / "tables" / name, content); !written) return written;
        return {};
    }

private:
    std::string in_namespace(std::string_view body) const {
        return fmt::format(
            "// Made by mavloom_dialectgen from {0}; do not edit.\n#include \"tables.hpp\"\n\n"
            "namespace {1} {{\n\nusing namespace mavloom::dialect;\nusing enum FieldType;\n\n{2}\n}}  // namespace "
            "{1}\n",
            options_.source, tables_, body);
    }

    std::string declarations() const {
        return fmt::format(
            "// Made by mavloom_dialectgen from {0}; do not edit.\n#pragma once\n\n"
            "#include \"mavloom/dialect/dialect.hpp\"\n\nnamespace {1} {{\n\n"
            "// One more than there are, so that none is of length 0.\n"
            "extern const mavloom::dialect::Enum enums[{2}];\n\n}}  // namespace {1}\n",
            options_.source, tables_, dialect_.enums().size() + 1);
    }

    // Records of one kind form one array. An owner refers to its records by first index and count.
    std::string enums() const {
        std::string params, entries, records;
        std::size_t param_count = 0, entry_count = 0;
        for (const auto& e : dialect_.enums()) {
            records += fmt::format("    {{{}, {}, {{entries + {}, {}}}, {}}},\n", text(e.name), e.bitmask, entry_count,
                                   e.entries.size(), text(e.deprecated));
            entry_count += e.entries.size();
            for (const auto& entry : e.entries) {
                const auto params_text = entry.params.empty()
                                             ? "{}"
                                             : fmt::format("{{params + {}, {}}}", param_count, entry.params.size());
                entries += fmt::format("    {{{}, {}u, {}, {}}},\n", text(entry.name), entry.value, params_text,
                                       text(entry.deprecated));
                param_count += entry.params.size();
                for (const auto& param : entry.params) params += fmt::format("    {},\n", text(param));
            }
        }
        return in_namespace(
            fmt::format("static constexpr CommandParam params[] = {{\n{}    {{}}}};\n\n"
                        "static constexpr EnumEntry entries[] = {{\n{}    {{}}}};\n\n"
                        "constinit const Enum enums[] = {{\n{}    {{}}}};\n",
                        params, entries, records));
    }

    std::string field_text(const Field& f) const {
        const auto enumeration = f.enumeration == nullptr
                                     ? "nullptr"
                                     : fmt::format("enums + {}", f.enumeration - dialect_.enums().data());
        return fmt::format("{{{}, {}, {}, {}, {}, {}, {}, {}, {}, {:#}, {}}}", text(f.name), text(f.type),
                           f.array_length, f.offset, f.extension, f.instance, f.bitmask, text(f.units), text(f.invalid),
                           f.multiplier, enumeration);
    }

    std::string messages() const {
        std::string fields, records;
        std::size_t field_count = 0;
        for (const auto& m : dialect_.messages()) {
            records += fmt::format(
                "    {{{}, {{mavloom::MessageId{{{}}}, {}, {}, {}, {}, {}, {}}}, {{fields + {}, {}}}, {}, {}}},\n",
                text(m.name), m.wire.id.value, m.wire.crc_extra, m.wire.min_length, m.wire.max_length,
                m.wire.target_system_offset, m.wire.target_component_offset, m.wire.boot_time_offset, field_count,
                m.fields.size(), text(m.origin), text(m.deprecated));
            field_count += m.fields.size();
            for (const auto& field : m.fields) fields += fmt::format("    {},\n", field_text(field));
        }
        return in_namespace(fmt::format("static constexpr Field fields[] = {{\n{}    {{}}}};\n\n"
                                        "static constexpr Message messages[] = {{\n{}    {{}}}};\n",
                                        fields, records)) +
               accessor();
    }

    std::string accessor() const {
        const std::string scope = options_.is_builtin ? "mavloom::dialect" : options_.cpp_namespace;
        return fmt::format(
            "\nnamespace {0} {{\n\n"
            "const mavloom::dialect::Dialect& {1}() {{\n"
            "    static const mavloom::dialect::Dialect dialect{{{2}, {{{3}::messages, {4}}}, {{{3}::enums, {5}}}}};\n"
            "    return dialect;\n}}\n\n}}  // namespace {0}\n",
            scope, options_.is_builtin ? "default_dialect" : "dialect", text(dialect_.name()), tables_,
            dialect_.messages().size(), dialect_.enums().size());
    }

    const Dialect& dialect_;
    const Options& options_;
    std::string tables_;
};

}  // namespace

SetupResult<void> write_tables(const Dialect& dialect, const Options& options) {
    return TableWriter(dialect, options).write();
}

}  // namespace mavloom::dialectgen
