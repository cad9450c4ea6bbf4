// SPDX-License-Identifier: MIT
#include "output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

namespace mavloom::dialectgen {
namespace {

constexpr std::string_view keywords[] = {
    "alignas",     "alignof",  "and",        "and_eq",    "asm",       "auto",         "bitand",
    "bitor",       "bool",     "break",      "case",      "catch",     "char",         "char16_t",
    "char32_t",    "char8_t",  "class",      "co_await",  "co_return", "co_yield",     "compl",
    "concept",     "const",    "const_cast", "consteval", "constexpr", "constinit",    "continue",
    "decltype",    "default",  "delete",     "do",        "double",    "dynamic_cast", "else",
    "enum",        "explicit", "export",     "extern",    "false",     "float",        "for",
    "friend",      "goto",     "if",         "inline",    "int",       "long",         "mutable",
    "namespace",   "new",      "noexcept",   "not",       "not_eq",    "nullptr",      "operator",
    "or",          "or_eq",    "private",    "protected", "public",    "register",     "reinterpret_cast",
    "requires",    "return",   "short",      "signed",    "sizeof",    "static",       "static_assert",
    "static_cast", "struct",   "switch",     "template",  "this",      "thread_local", "throw",
    "true",        "try",      "typedef",    "typeid",    "typename",  "union",        "unsigned",
    "using",       "virtual",  "void",       "volatile",  "wchar_t",   "while",        "xor",
    "xor_eq"};

// Macros of the standard and system headers that look like names of fields or entries.
constexpr std::string_view macros[] = {"assert", "errno",   "stdin",  "stdout",   "stderr",   "major",
                                       "minor",  "makedev", "NAN",    "INFINITY", "NULL",     "EOF",
                                       "linux",  "unix",    "DOMAIN", "OVERFLOW", "UNDERFLOW"};

// Names that the generated struct itself uses: its members, the parameter of `encode`, the namespaces it names.
constexpr std::string_view struct_names[] = {"id",     "name",   "crc_extra", "min_length", "max_length",
                                             "decode", "encode", "out",       "mavloom",    "std"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_taken(std::string_view name) {
    return std::ranges::find(keywords, name) != std::end(keywords) ||
           std::ranges::find(macros, name) != std::end(macros);
}

}  // namespace

std::string literal(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\' || c == '?') {
            out += {'\\', c};
        } else if (byte < 0x20 || byte >= 0x7f) {
            out += fmt::format("\\{:03o}", byte);
        } else {
            out += c;
        }
    }
    return out + '"';
}

std::string pascal_case(std::string_view name) {
    std::string out;
    bool word_begins = true;
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (name[i] == '_') {
            const bool between_digits = !out.empty() && is_digit(out.back()) && i + 1 < name.size() &&
                                        is_digit(name[i + 1]);
            if (between_digits) out += '_';
            word_begins = true;
            continue;
        }
        out += word_begins ? upper(name[i]) : lower(name[i]);
        word_begins = false;
    }
    return out.empty() || is_digit(out.front()) ? "M" + out : out;
}

std::string lower_case(std::string_view name) {
    std::string out(name);
    std::ranges::transform(out, out.begin(), lower);
    return out;
}

std::string safe_enumerator(std::string_view name) {
    std::string out(is_digit(name.front()) ? "_" : "");
    out += name;
    return is_taken(out) ? out + '_' : out;
}

std::string safe_member(std::string_view name, std::string_view struct_name) {
    auto out = safe_enumerator(name);
    const bool collides = out == struct_name || std::ranges::find(struct_names, out) != std::end(struct_names);
    return collides ? out + '_' : out;
}

SetupResult<void> write_file(const std::filesystem::path& path, std::string_view content) {
    {
        std::ifstream present(path, std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(present), {}};
        if (present && text == content) return {};
    }
    std::error_code failure;
    std::filesystem::create_directories(path.parent_path(), failure);
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file << content;
    file.close();
    if (!file) return system_error("cannot write " + path.string(), errno);
    return {};
}

}  // namespace mavloom::dialectgen
