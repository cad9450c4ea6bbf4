// SPDX-License-Identifier: MIT
// Checks of a configuration that only routers need. `mavloom check` and `mavloom route` both run them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "config/places.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/endpoint/checks.hpp"

namespace mavloom::config {

namespace {

tl::unexpected<SetupError> bad(std::string_view file_name, std::uint32_t line, std::string_view what) {
    return setup_error(SetupCode::bad_input, fmt::format("{}:{}: {}", file_name, line, what));
}

// The section's line in the file; 0 if the file does not have it.
std::uint32_t line_of_section(const Config& config, std::string_view name) {
    const auto section = std::ranges::find(config.sections, name, &Section::name);
    return section == config.sections.end() ? 0 : section->line;
}

// A section without its name or path would have no effect, so it is an error.
SetupResult<void> check_sections(const Config& config, std::string_view file_name) {
    if (const auto line = line_of_section(config, "ring"); line != 0 && config.ring.name.empty())
        return bad(file_name, line, "[ring] has no name: write name = \"...\", or start the router with --ring NAME");
    if (const auto line = line_of_section(config, "record"); line != 0 && config.record.path.empty())
        return bad(file_name, line, "[record] has no path: write path = \"flight.tlog\"");
    return {};
}

// Rejects endpoints that Links::add would reject immediately.
SetupResult<void> check_links(const Config& config, std::string_view file_name) {
    return detail::each_endpoint(
        config, [&](const endpoint::Endpoint& endpoint, const Section& section) -> SetupResult<void> {
            static constexpr std::array<std::string_view, 3> own{"ring", "url", "scheme"};
            auto good = endpoint.is_recording() ? endpoint::check_written(endpoint)
                                                : endpoint::check_link(endpoint, endpoint::RoutingOptions::by_owner);
            return good ? good : bad(file_name, detail::line_of(section, own), good.error().text);
        });
}

// Rejects an endpoint that calls the port of an earlier one, or the other way round.
SetupResult<void> check_no_loops(const Config& config, std::string_view file_name) {
    std::vector<const endpoint::Endpoint*> earlier;
    return detail::each_endpoint(config,
                                 [&](const endpoint::Endpoint& endpoint, const Section& section) -> SetupResult<void> {
                                     static constexpr std::array<std::string_view, 3> own{"url", "port", "scheme"};
                                     for (const auto* other : earlier)
                                         if (auto good = endpoint::check_not_called(*other, endpoint); !good)
                                             return bad(file_name, detail::line_of(section, own), good.error().text);
                                     earlier.push_back(&endpoint);
                                     return {};
                                 });
}

SetupResult<void> check_groups(const Config& config, std::string_view file_name) {
    struct Chosen {
        endpoint::GroupMode mode;
        std::uint32_t line;
    };
    std::map<std::string, Chosen> chosen;
    return detail::each_endpoint(
        config, [&](const endpoint::Endpoint& endpoint, const Section& section) -> SetupResult<void> {
            static constexpr std::array<std::string_view, 1> own{"group_mode"};
            const auto& o = endpoint.options;
            if (o.group.empty() || !o.has_group_mode) return {};
            const auto line = detail::line_of(section, own);
            const auto [first, is_first] = chosen.try_emplace(o.group, Chosen{o.group_mode, line});
            if (is_first || first->second.mode == o.group_mode) return {};
            return bad(file_name, line,
                       fmt::format("group {} has group_mode \"{}\" in line {}, and \"{}\" here; a group has one mode",
                                   in_quotes(o.group), endpoint::group_mode_name(first->second.mode),
                                   first->second.line, endpoint::group_mode_name(o.group_mode)));
        });
}

}  // namespace

SetupResult<void> check_for_router(const Config& config, std::string_view file_name, const dialect::Dialect& dialect) {
    if (auto good = check_links(config, file_name); !good) return good;
    if (auto good = check_no_loops(config, file_name); !good) return good;
    if (auto good = check_sections(config, file_name); !good) return good;
    if (auto good = check_groups(config, file_name); !good) return good;
    if (auto good = check_message_names(config, file_name, dialect); !good) return good;
    return check_key_files(config, file_name);
}

}  // namespace mavloom::config
