// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "generate.hpp"
#include "output.hpp"

namespace mavloom::dialectgen {
namespace {

using dialect::Enum;
using dialect::Field;
using dialect::FieldType;
using dialect::Message;

std::string_view cpp_type(FieldType type) {
    constexpr std::string_view names[] = {"char",         "std::uint8_t",  "std::int8_t",  "std::uint16_t",
                                          "std::int16_t", "std::uint32_t", "std::int32_t", "std::uint64_t",
                                          "std::int64_t", "float",         "double"};
    return names[static_cast<std::size_t>(type)];
}

std::string member_type(const Field& field) {
    if (!field.is_array()) return std::string(cpp_type(field.type));
    return fmt::format("std::array<{}, {}>", cpp_type(field.type), field.array_length);
}

// Returns the comment after a field: its unit, enum and other facts of the definition.
std::string note(const Field& field) {
    std::vector<std::string> facts;
    if (!field.units.empty()) facts.push_back(fmt::format("[{}]", field.units));
    if (field.multiplier != 0) facts.push_back(fmt::format("times {}", field.multiplier));
    if (field.enumeration != nullptr) {
        facts.push_back(fmt::format("{}{}", field.bitmask ? "flags of " : "", field.enumeration->name));
    } else if (field.bitmask) {
        facts.emplace_back("flags");
    }
    if (!field.invalid.empty()) facts.push_back(fmt::format("none: {}", field.invalid));
    if (field.instance) facts.emplace_back("instance");
    if (field.extension) facts.emplace_back("extension");
    return facts.empty() ? "" : fmt::format("  // {}", fmt::join(facts, "; "));
}

std::string deprecation(const dialect::Deprecation& deprecated) {
    if (deprecated.since.empty()) return "";
    const auto instead = deprecated.replaced_by.empty() ? "" : fmt::format(", replaced by {}", deprecated.replaced_by);
    return fmt::format("// Deprecated since {}{}.\n", deprecated.since, instead);
}

std::string preamble(const Options& options) {
    return fmt::format("// Made by mavloom_dialectgen from {}; do not edit.\n#pragma once\n\n", options.source);
}

std::string struct_text(const Message& message, const std::string& name) {
    std::string fields, reads, writes;
    for (const auto& field : message.fields) {
        const auto member = safe_member(field.name, name);
        fields += fmt::format("    {} {}{{}};{}\n", member_type(field), member, note(field));
        reads += fmt::format("        bytes.get<{}>(message.{});\n", field.offset, member);
        writes += fmt::format("        mavloom::dialect::put<{}>(out, {});\n", field.offset, member);
    }
    const auto& wire = message.wire;
    return fmt::format(
        "// {0} ({1}), defined in {2}. Fields in the order of the definition; values in the unit and scale of the "
        "wire.\n{3}"
        "struct {4} {{\n"
        "    static constexpr mavloom::MessageId id{{{1}}};\n"
        "    static constexpr const char* name = {5};\n"
        "    static constexpr std::uint8_t crc_extra = {6};\n"
        "    static constexpr std::uint8_t min_length = {7};\n"
        "    static constexpr std::uint8_t max_length = {8};\n\n"
        "{9}\n"
        "    // Bytes that the sender cut off are 0; bytes beyond max_length are not looked at.\n"
        "    [[nodiscard]] static {4} decode(mavloom::ByteView payload) noexcept {{\n"
        "        const mavloom::dialect::FullPayload<max_length> bytes(payload);\n"
        "        {4} message;\n"
        "{10}"
        "        return message;\n"
        "    }}\n\n"
        "    // Writes the full payload; `out` holds at least max_length bytes. Gives max_length.\n"
        "    std::size_t encode(mavloom::ByteSpan out) const noexcept {{\n"
        "        assert(out.size() >= max_length);\n"
        "{11}"
        "        return max_length;\n"
        "    }}\n\n"
        "    friend bool operator==(const {4}&, const {4}&) = default;\n"
        "}};\n",
        message.name, wire.id.value, message.origin, deprecation(message.deprecated), name, literal(message.name),
        wire.crc_extra, wire.min_length, wire.max_length, fields, reads, writes);
}

std::string message_header(const Message& message, const std::string& name, const Options& options) {
    return fmt::format(
        "{0}#include <array>\n#include <cassert>\n#include <cstddef>\n#include <cstdint>\n\n"
        "#include \"mavloom/dialect/struct_io.hpp\"\n\nnamespace {1} {{\n\n{2}\n}}  // namespace {1}\n",
        preamble(options), options.cpp_namespace, struct_text(message, name));
}

std::string_view underlying_type(const Enum& e) {
    const auto highest = e.entries.empty() ? 0 : e.entries.back().value;
    if (highest <= 0xff) return "std::uint8_t";
    if (highest <= 0xffff) return "std::uint16_t";
    return highest <= 0xffff'ffff ? "std::uint32_t" : "std::uint64_t";
}

std::string enum_header(const Enum& e, const Options& options) {
    std::string entries;
    for (const auto& entry : e.entries)
        entries += fmt::format("    {} = {}u,\n", safe_enumerator(entry.name), entry.value);
    return fmt::format(
        "{0}#include <cstdint>\n\nnamespace {1} {{\n\n"
        "// {2}{3}. Plain enumerators, so that they compare with and assign to the integer fields of messages.\n{4}"
        "enum {5} : {6} {{\n{7}}};\n\n}}  // namespace {1}\n",
        preamble(options), options.cpp_namespace, e.name, e.bitmask ? ", flags" : "", deprecation(e.deprecated),
        pascal_case(e.name), underlying_type(e), entries);
}

// Reports an error if two XML names become the same C++ or file name.
SetupResult<void> claim(std::map<std::string, std::string_view>& taken, const std::string& key,
                        std::string_view xml_name) {
    const auto [at, is_new] = taken.emplace(key, xml_name);
    if (is_new) return {};
    return setup_error(SetupCode::bad_input,
                       fmt::format("{} and {} would both become {}; expected names that differ in more "
                                   "than case and underscores",
                                   at->second, xml_name, key));
}

// dialect.hpp: the function that gives the whole dialect, for those who need more than structs.
std::string dialect_header(const Options& options) {
    return fmt::format(
        "{0}#include \"mavloom/dialect/dialect.hpp\"\n\nnamespace {1} {{\n\n"
        "// The definitions of {2} and everything it includes. Immutable.\n"
        "[[nodiscard]] const mavloom::dialect::Dialect& dialect();\n\n}}  // namespace {1}\n",
        preamble(options), options.cpp_namespace, options.source);
}

}  // namespace

std::string include_folder(const Options& options) {
    std::string folder = options.cpp_namespace;
    for (auto at = folder.find("::"); at != std::string::npos; at = folder.find("::", at)) folder.replace(at, 2, "/");
    return folder;
}

SetupResult<void> write_headers(const dialect::Dialect& dialect, const Options& options) {
    const auto folder = options.out / "include" / include_folder(options);
    std::map<std::string, std::string_view> taken;
    for (const auto& message : dialect.messages()) {
        const auto name = pascal_case(message.name);
        if (auto free = claim(taken, name, message.name); !free) return free;
        auto written = write_file(folder / (lower_case(message.name) + ".hpp"), message_header(message, name, options));
        if (!written) return written;
    }
    for (const auto& e : dialect.enums()) {
        if (auto free = claim(taken, pascal_case(e.name), e.name); !free) return free;
        auto written = write_file(folder / "enums" / (lower_case(e.name) + ".hpp"), enum_header(e, options));
        if (!written) return written;
    }
    return options.is_builtin ? SetupResult<void>{} : write_file(folder / "dialect.hpp", dialect_header(options));
}

}  // namespace mavloom::dialectgen
