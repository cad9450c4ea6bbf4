// SPDX-License-Identifier: MIT
// Reads an [[endpoint]] table of a configuration or a scenario.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/config/document.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::config {

namespace {

constexpr std::array<std::string_view, 7> place_keys{"url", "scheme", "host", "port", "path", "ring", "name"};

// True for the keys that give the endpoint's address or path, if its scheme has them.
bool is_place_of(endpoint::Scheme scheme, std::string_view key) {
    if (key == "url" || key == "scheme") return true;
    const auto form = endpoint::row_of(scheme).form;
    const bool is_address = key == "host" || key == "port";
    if (form == endpoint::Form::address) return is_address;
    if (form == endpoint::Form::address_and_path) return is_address || key == "path";
    return key == (form == endpoint::Form::ring ? "ring" : "path");
}

// Keys of other programs' files, and what to write instead.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> foreign_keys{
    {{"device", "path"}, {"address", "host"}, {"baudrate", "baud"}, {"flow_control", "flow"}, {"type", "scheme"}}};

class Reader {
public:
    Reader(const Document& document, const Table& table) : document_(document), table_(table) {}

    SetupResult<PlacedEndpoint> read() {
        for (const Entry& entry : table_.entries) {
            auto text = document_.text_of(entry);
            if (!text) return tl::unexpected(std::move(text.error()));
            given_.push_back({entry.key, std::move(*text), Origin::file, entry.line, {}});
        }
        if (auto good = check_words(); !good) return tl::unexpected(std::move(good.error()));
        auto endpoint = place();
        if (!endpoint) return tl::unexpected(std::move(endpoint.error()));
        for (const Setting& setting : given_) {
            if (is_place_of(endpoint->scheme, setting.key)) continue;
            if (auto done = endpoint::set_endpoint_option(*endpoint, setting.key, setting.value); !done)
                return bad(setting.line, done.error().text);
        }
        if (auto good = endpoint::check_options(*endpoint); !good) return bad(table_.line, good.error().text);
        if (endpoint->has_address() && endpoint->address.port == 0)
            return bad(table_.line, "with port 0, other programs could not know the port; choose one from 1 to 65535");
        Section section = section_of(*endpoint);
        return PlacedEndpoint{std::move(*endpoint), std::move(section)};
    }

private:
    [[nodiscard]] tl::unexpected<SetupError> bad(std::uint32_t line, std::string_view what) const {
        return document_.error(line, what);
    }
    [[nodiscard]] const Setting* find(std::string_view key) const {
        const auto found = std::ranges::find(given_, key, &Setting::key);
        return found == given_.end() ? nullptr : &*found;
    }

    [[nodiscard]] SetupResult<void> check_words() const {
        for (const Setting& setting : given_)
            for (const auto& [foreign, own] : foreign_keys)
                if (setting.key == foreign)
                    return bad(setting.line, fmt::format("[[endpoint]] has no key '{}'; write {} = \"{}\"", foreign,
                                                         own, shown(setting.value)));
        return {};
    }

    SetupResult<endpoint::Endpoint> place() {
        const Setting* const url = find("url");
        if (url == nullptr) return place_of_parts();
        for (const auto key : {"scheme", "host", "port", "path", "ring"})
            if (const auto* part = find(key))
                return bad(part->line, fmt::format("'{}' is given beside url, which already contains it", key));
        auto endpoint = endpoint::parse_endpoint(url->value);
        if (!endpoint) return bad(url->line, endpoint.error().text);
        const auto query = endpoint::query_of(url->value);
        if (!query) return endpoint;
        const auto options = endpoint::split_query(*query);
        if (!options) return bad(url->line, options.error().text);
        const auto url_line = url->line;
        for (const auto& option : *options) {
            if (const auto* twice = find(option.key))
                return bad(twice->line, fmt::format("'{}' is already set in the url", option.key));
            given_.push_back({option.key, option.value, Origin::file, url_line, {}});
        }
        return endpoint;
    }

    SetupResult<endpoint::Endpoint> place_of_parts() const {
        const Setting* const scheme = find("scheme");
        if (scheme == nullptr) return without_scheme();
        const auto found = endpoint::parse_scheme(scheme->value);
        if (!found) return bad(scheme->line, found.error().text);
        endpoint::Endpoint endpoint;
        endpoint.scheme = *found;
        return endpoint.has_address() ? place_of_address(std::move(endpoint)) : place_of_path(std::move(endpoint));
    }

    [[nodiscard]] tl::unexpected<SetupError> without_scheme() const {
        for (const Setting& setting : given_)
            if (const auto hint = did_you_mean(setting.key, place_keys);
                !hint.empty() && std::ranges::find(place_keys, setting.key) == place_keys.end())
                return bad(setting.line, fmt::format("[[endpoint]] has no key {}{}", in_quotes(setting.key), hint));
        return bad(table_.line, "an endpoint needs url = \"...\", or scheme and the keys for that scheme");
    }

    SetupResult<endpoint::Endpoint> place_of_path(endpoint::Endpoint endpoint) const {
        const bool is_ring = endpoint.is_ring();
        const auto* path = find(is_ring ? "ring" : "path");
        if (path == nullptr)
            return bad(table_.line, fmt::format("{} needs {}", endpoint::scheme_name(endpoint.scheme),
                                                is_ring ? "ring = \"NAME\"" : "path = \"...\""));
        if (auto good = endpoint::check_path(endpoint.scheme, path->value); !good)
            return bad(path->line, good.error().text);
        endpoint.path = path->value;
        return endpoint;
    }

    SetupResult<endpoint::Endpoint> place_of_address(endpoint::Endpoint endpoint) const {
        const auto name = endpoint::scheme_name(endpoint.scheme);
        const auto* host = find("host");
        const auto* port = find("port");
        if (host == nullptr || port == nullptr)
            return bad(table_.line, fmt::format("{} needs {}", name, host == nullptr ? "host = \"...\"" : "port = N"));
        auto parsed_host = endpoint::parse_host(host->value, name, port->value);
        if (!parsed_host) return bad(host->line, fmt::format("host: {}", parsed_host.error().text));
        const auto parsed_port = endpoint::parse_port(port->value);
        if (!parsed_port) return bad(port->line, parsed_port.error().text);
        endpoint.address = {std::move(*parsed_host), *parsed_port};
        if (auto good = endpoint::check_address(endpoint.scheme, endpoint.address); !good)
            return bad(host->line, good.error().text);
        const auto* path = find("path");
        if (path == nullptr || endpoint.row().form != endpoint::Form::address_and_path) return endpoint;
        if (auto good = endpoint::check_path(endpoint.scheme, path->value); !good)
            return bad(path->line, good.error().text);
        endpoint.path = path->value;
        return endpoint;
    }

    [[nodiscard]] Section section_of(const endpoint::Endpoint& endpoint) const {
        Section section{"endpoint", endpoint.label(), {}};
        for (const auto key : place_keys)
            if (const auto* setting = find(key); setting != nullptr && key != "name")
                section.settings.push_back(*setting);
        for (const auto key : endpoint::option_names_for(endpoint.scheme)) {
            const auto* setting = find(key);
            section.settings.push_back(setting != nullptr
                                           ? *setting
                                           : Setting{std::string(key),
                                                     std::string(endpoint::default_option_text(endpoint.scheme, key)),
                                                     Origin::by_default,
                                                     0,
                                                     {}});
        }
        return section;
    }

    const Document& document_;
    const Table& table_;
    std::vector<Setting> given_;
};

}  // namespace

SetupResult<PlacedEndpoint> read_endpoint(const Document& document, const Table& table,
                                          std::span<const Section> earlier) {
    auto placed = Reader(document, table).read();
    if (!placed) return placed;
    const Section& own = placed->section;
    if (std::ranges::any_of(earlier, [&](const Section& s) { return s.name == own.name && s.label == own.label; }))
        return document.error(
            table.line, fmt::format("two endpoints are named {}; remove one of them, or give it another name = \"...\"",
                                    in_quotes(own.label)));
    return placed;
}

}  // namespace mavloom::config
