// SPDX-License-Identifier: MIT
#include "config/convert_ini.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mavloom/base/text.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::config::detail {

namespace {

class IniReader {
public:
    explicit IniReader(std::string_view file) : file_(file) {}

    SetupResult<std::vector<IniSection>> read(std::string_view text) {
        while (!text.empty()) {
            const auto end = text.find('\n');
            ++line_;
            if (auto done = read_line(trimmed(text.substr(0, end))); !done)
                return tl::unexpected(std::move(done.error()));
            text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
        }
        return std::move(sections_);
    }

private:
    [[nodiscard]] tl::unexpected<SetupError> bad(std::string_view what) const {
        return setup_error(SetupCode::bad_input, fmt::format("{}:{}: {}", file_, line_, what));
    }

    SetupResult<void> read_line(std::string_view line) {
        if (line.empty() || line.front() == '#' || line.front() == ';') return {};
        return line.front() == '[' ? open_section(line) : add_entry(line);
    }

    SetupResult<void> open_section(std::string_view line) {
        const auto end = line.find(']');
        if (end == std::string_view::npos) return bad("the bracket of the section is not closed");
        if (end + 1 != line.size())
            return bad(
                fmt::format("{} follows the closing bracket of the section", in_quotes(trimmed(line.substr(end + 1)))));
        const auto name = line.substr(1, end - 1);
        if (name.empty() || trimmed(name).size() != name.size())
            return bad("a section's name must not begin or end with a blank, as in [UdpEndpoint ground]");
        current_ = std::ranges::find_if(sections_, [&](const IniSection& s) { return same_letters(s.name, name); }) -
                   sections_.begin();
        if (current_ == static_cast<std::ptrdiff_t>(sections_.size()))
            sections_.push_back({std::string(name), line_, {}});
        else sections_[static_cast<std::size_t>(current_)].continued.push_back(line_);
        return {};
    }

    SetupResult<void> add_entry(std::string_view line) {
        if (sections_.empty()) return bad(fmt::format("{} comes before the first section", in_quotes(line)));
        const auto equals = line.find('=');
        if (equals == std::string_view::npos)
            return bad(fmt::format("{} is neither [Section] nor key = value", in_quotes(line)));
        const auto key = trimmed(line.substr(0, equals)), value = trimmed(line.substr(equals + 1));
        if (key.empty()) return bad("there is no key before '='");
        if (value.empty()) return bad(fmt::format("{} has no value", shown(key)));
        auto& entries = sections_[static_cast<std::size_t>(current_)].entries;
        const auto before = std::ranges::find_if(entries, [&](const IniEntry& e) { return same_letters(e.key, key); });
        if (before != entries.end()) entries.erase(before);
        entries.push_back({std::string(key), std::string(value), line_});
        return {};
    }

    std::string_view file_;
    std::uint32_t line_ = 0;
    std::vector<IniSection> sections_;
    std::ptrdiff_t current_ = 0;
};

}  // namespace

const IniEntry* IniSection::find(std::string_view key) const noexcept {
    const auto found = std::ranges::find_if(entries, [&](const IniEntry& e) { return same_letters(e.key, key); });
    return found == entries.end() ? nullptr : &*found;
}

SetupResult<std::vector<IniSection>> parse_ini(std::string_view text, std::string_view file_name) {
    return IniReader(file_name).read(text);
}

}  // namespace mavloom::config::detail
