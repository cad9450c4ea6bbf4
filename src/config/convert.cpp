// SPDX-License-Identifier: MIT
#include "mavloom/config/convert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "config/convert_ini.hpp"
#include "config/text.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/base/text.hpp"
#include "mavloom/config/config.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::config {

using namespace detail;

namespace {

// A mavlink-router key without counterpart, and the value that means the same as no key.
struct WithoutCounterpart {
    std::string_view key, default_value, advice;
};

constexpr std::array general_without{
    WithoutCounterpart{"ReportStats", "false", "nothing is printed; `mavloom stat` shows the counters at any time"},
    WithoutCounterpart{"MavlinkDialect", "auto", "it was only needed to fetch a flight stack's logs"},
    WithoutCounterpart{"Log", "", "the flight stack's own logs (ULog, DataFlash) are not fetched"},
    WithoutCounterpart{"LogMode", "always", "a recording runs from start to end, armed or not"},
    WithoutCounterpart{"LogSystemId", "", "the flight stack's own logs (ULog, DataFlash) are not fetched"},
    WithoutCounterpart{"MinFreeSpace", "0", "no recording is ever deleted"},
    WithoutCounterpart{"MaxLogFiles", "0", "no recording is ever deleted"},
    WithoutCounterpart{"SnifferSysid", "0", "tap = true on that system's endpoint sends it everything"},
};
constexpr std::array<std::string_view, 4> general_keys{"TcpServerPort", "DebugLogLevel", "DeduplicationPeriod",
                                                       "LogTelemetry"};
constexpr std::array<std::string_view, 3> uart_keys{"Device", "Baud", "FlowControl"};
constexpr std::array<std::string_view, 4> udp_keys{"Mode", "Address", "Port", "Filter"};
constexpr std::array<std::string_view, 3> tcp_keys{"Address", "Port", "RetryTimeout"};

// The part of a filter key between Allow/Block and In/Out, and our prefix for such an id.
struct FilterKind {
    std::string_view word, prefix;
    std::uint64_t most;
};
constexpr std::array filter_kinds{FilterKind{"MsgId", "", 0xFFFFFF}, FilterKind{"SrcSys", "sys:", 255},
                                  FilterKind{"SrcComp", "comp:", 255}};

struct FilterOption {
    std::string_view option, action, direction;
};
constexpr std::array filter_options{FilterOption{"in_allow", "Allow", "In"}, FilterOption{"in_block", "Block", "In"},
                                    FilterOption{"out_allow", "Allow", "Out"},
                                    FilterOption{"out_block", "Block", "Out"}};

constexpr std::uint64_t default_tcp_port = 5760, first_udp_port = 14550;
constexpr std::uint64_t max_dedup_ms = 60'000;

bool is_off(std::string_view text) { return text == "0" || same_letters(text, "false"); }

bool is_default(std::string_view value, std::string_view default_value) {
    return same_letters(value, default_value) || (default_value == "false" && is_off(value));
}

std::string toml_string(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7F)
            result += fmt::format("\\u{:04X}", byte);
        else result += c;
    }
    return result + '"';
}

// Splits a section's heading into its kind and its name.
std::pair<std::string_view, std::string_view> heading(const IniSection& section) {
    const std::string_view text = section.name;
    const auto blank = text.find(' ');
    return blank == std::string_view::npos ? std::pair{text, std::string_view{}}
                                           : std::pair{text.substr(0, blank), text.substr(blank + 1)};
}

class Converter {
public:
    Converter(std::string_view file, const std::vector<IniSection>& sections) : file_(file), sections_(sections) {}

    SetupResult<Conversion> convert() {
        toml_ =
            "# Converted from a configuration of mavlink-router by `mavloom check --convert`.\n\n[router]\n"
            "unknown_component = \"drop\"  # as mavlink-router does; \"system\" is the MAVLink guide's rule\n";
        if (auto done = read_general(); !done) return tl::unexpected(std::move(done.error()));
        find_taken_ports();
        for (const auto& section : sections_)
            if (auto done = read_section(section); !done) return tl::unexpected(std::move(done.error()));
        if (tcp_port_ != 0)
            toml_ += fmt::format("\n[[endpoint]]\nurl = \"tcpin://[::]:{}\"\nname = {}\n", tcp_port_,
                                 toml_string(unique_name("tcp-server")));
        std::ranges::stable_sort(notes_, {}, &ConversionNote::line);
        if (const auto made = parse_config(toml_, "converted"); !made)
            return setup_error(SetupCode::bad_input, fmt::format("{}:1: the result is not a valid configuration: {}",
                                                                 file_, shown(made.error().text)));
        return Conversion{std::move(toml_), std::move(notes_)};
    }

private:
    [[nodiscard]] tl::unexpected<SetupError> bad(std::uint32_t line, std::string_view what) const {
        return setup_error(SetupCode::bad_input, fmt::format("{}:{}: {}", file_, line, what));
    }

    void note(const IniSection& section, const IniEntry& entry, std::string_view text) {
        notes_.push_back({entry.line, section.name, entry.key, std::string(text)});
    }
    void note(const IniSection& section, std::string_view text) {
        notes_.push_back({section.line, section.name, {}, std::string(text)});
    }
    void put_key(std::string_view key, std::string_view toml_value) {
        toml_ += fmt::format("{} = {}\n", key, toml_value);
    }

    // ---- [General] --------------------------------------------------------------------------------------------------

    SetupResult<void> read_general() {
        const auto found = std::ranges::find_if(sections_,
                                                [](const IniSection& s) { return same_letters(s.name, "General"); });
        if (found == sections_.end()) return {};
        const IniSection& general = *found;
        auto port = number(general, "TcpServerPort", 0, 65535, default_tcp_port);
        if (!port) return tl::unexpected(std::move(port.error()));
        tcp_port_ = *port;
        if (auto done = read_dedup(general); !done) return done;
        if (auto done = read_log_level(general); !done) return done;
        read_recording(general);
        for (const auto& left : general_without)
            if (const auto* entry = general.find(left.key);
                entry != nullptr && !is_default(entry->value, left.default_value))
                note(general, *entry, left.advice);
        std::vector<std::string_view> known(general_keys.begin(), general_keys.end());
        for (const auto& left : general_without) known.push_back(left.key);
        note_unknown_keys(general, known);
        return {};
    }

    SetupResult<void> read_dedup(const IniSection& general) {
        const auto period = number(general, "DeduplicationPeriod", 0, 0xFFFFFFFF, 0);
        if (!period) return tl::unexpected(period.error());
        if (*period != 0) put_key("dedup_ms", fmt::format("{}", std::min(*period, max_dedup_ms)));
        if (*period > max_dedup_ms)
            note(general, *general.find("DeduplicationPeriod"), fmt::format("the maximum is {} ms", max_dedup_ms));
        return {};
    }

    SetupResult<void> read_log_level(const IniSection& general) {
        const auto* entry = general.find("DebugLogLevel");
        if (entry == nullptr) return {};
        for (const std::string_view level : {"error", "warning", "info", "debug", "trace"}) {
            if (!same_letters(entry->value, level)) continue;
            toml_ += fmt::format("\n[log]\nlevel = \"{}\"\n", level == "trace" ? "debug" : level);
            return {};
        }
        return bad(entry->line, fmt::format("DebugLogLevel: {} is none of error, warning, info, debug, trace",
                                            in_quotes(entry->value)));
    }

    void read_recording(const IniSection& general) {
        const auto* telemetry = general.find("LogTelemetry");
        if (telemetry == nullptr || is_off(telemetry->value)) return;
        const auto* folder = general.find("Log");
        if (folder == nullptr) return note(general, *telemetry, "without Log there is no folder to record into");
        const auto path = (std::filesystem::path(folder->value) / "telemetry.tlog").string();
        toml_ += fmt::format("\n[record]\npath = {}\n", toml_string(path));
        note(general, *telemetry, fmt::format("recorded to {}; older files are kept as .1, .2 and so on", path));
    }

    // ---- endpoints --------------------------------------------------------------------------------------------------

    SetupResult<void> read_section(const IniSection& section) {
        const auto [kind, name] = heading(section);
        if (same_letters(section.name, "General")) return {};
        const bool uart = same_letters(kind, "UartEndpoint"), udp = same_letters(kind, "UdpEndpoint"),
                   tcp = same_letters(kind, "TcpEndpoint");
        if (!uart && !udp && !tcp) {
            constexpr std::array<std::string_view, 4> kinds{"General", "UartEndpoint", "UdpEndpoint", "TcpEndpoint"};
            note(section, fmt::format("mavlink-router has no such section{}", did_you_mean(kind, kinds)));
            return {};
        }
        if (name.empty()) {
            note(section, "mavlink-router ignores an endpoint without a name");
            return {};
        }
        for (const auto line : section.continued)
            notes_.push_back({line,
                              section.name,
                              {},
                              fmt::format("continues the section of line {}, as in mavlink-router; for a second "
                                          "endpoint, give it another name",
                                          section.line)});
        toml_ += "\n[[endpoint]]\n";
        if (auto done = uart ? read_uart(section) : udp ? read_udp(section) : read_tcp(section); !done) return done;
        put_key("name", toml_string(unique_name(name)));
        if (const auto* group = section.find("Group")) put_key("group", toml_string(group->value));
        for (const auto& option : filter_options)
            if (auto done = read_filter(section, option); !done) return done;
        note_unknown_endpoint_keys(section, uart  ? std::span<const std::string_view>(uart_keys)
                                            : udp ? std::span<const std::string_view>(udp_keys)
                                                  : std::span<const std::string_view>(tcp_keys));
        return {};
    }

    SetupResult<void> read_uart(const IniSection& section) {
        const auto* device = section.find("Device");
        if (device == nullptr) return bad(section.line, fmt::format("[{}] has no Device", shown(section.name)));
        put_key("scheme", "\"serial\"");
        put_key("path", toml_string(device->value));
        if (auto done = read_baud(section); !done) return done;
        if (const auto* flow = section.find("FlowControl"); flow != nullptr && !is_off(flow->value))
            put_key("flow", "\"rtscts\"");
        return {};
    }

    SetupResult<void> read_baud(const IniSection& section) {
        const auto* baud = section.find("Baud");
        if (baud == nullptr) {
            put_key("baud", "115200");
            return {};
        }
        const auto rates = numbers(*baud, 1, 30'000'000);
        if (!rates) return tl::unexpected(rates.error());
        if (rates->size() == 1) {
            put_key("baud", fmt::format("{}", rates->front()));
        } else {
            put_key("baud", "\"auto\"");
            note(section, *baud, "baud = \"auto\" tries the usual rates, not a list of your own");
        }
        return {};
    }

    SetupResult<void> read_udp(const IniSection& section) {
        const auto* mode = section.find("Mode");
        const auto* address = section.find("Address");
        if (address == nullptr || mode == nullptr)
            return bad(section.line,
                       fmt::format("[{}] has no {}", shown(section.name), address == nullptr ? "Address" : "Mode"));
        if (same_letters(mode->value, "Server") || same_letters(mode->value, "Eavesdropping")) {
            const auto* port = section.find("Port");
            if (port == nullptr) return bad(section.line, fmt::format("[{}] has no Port", shown(section.name)));
            if (auto good = check_port_is_free(section, *address, *port); !good) return good;
            return put_url("udpin", *address, *port);
        }
        if (!same_letters(mode->value, "Normal") && !same_letters(mode->value, "Client"))
            return bad(mode->line, fmt::format("Mode: {} is neither Normal nor Server", in_quotes(mode->value)));
        const auto* given_port = section.find("Port");
        const IniEntry port = given_port != nullptr
                                  ? *given_port
                                  : IniEntry{"Port", fmt::format("{}", take_free_port()), section.line};
        if (given_port == nullptr) note(section, port, fmt::format("not given; mavlink-router uses {}", port.value));
        return put_destination(section, *address, port);
    }

    // Two servers cannot bind one port.
    SetupResult<void> check_port_is_free(const IniSection& section, const IniEntry& address, const IniEntry& port) {
        const auto is_any = [](std::string_view host) { return host == "0.0.0.0" || host == "[::]"; };
        for (const auto& server : servers_)
            if (server.port == port.value &&
                (server.address == address.value || is_any(server.address) || is_any(address.value)))
                return bad(port.line,
                           fmt::format("[{}] listens on UDP port {}, as [{}] in line {} does; choose another "
                                       "Port for one of them",
                                       shown(section.name), shown(port.value), shown(server.section), server.line));
        servers_.push_back({address.value, port.value, section.name, port.line});
        return {};
    }

    // In Normal mode, the kind of address decides the scheme.
    SetupResult<void> put_destination(const IniSection& section, const IniEntry& address, const IniEntry& port) {
        if (address.value == "0.0.0.0" || address.value == "[::]") {
            IniEntry here = address;
            here.value = address.value == "[::]" ? "[::1]" : "127.0.0.1";
            note(section, address, fmt::format("nothing can be sent to {}; converted to {}", address.value, here.value));
            return put_url("udpout", here, port);
        }
        if (endpoint::parse_endpoint(fmt::format("udpmcast://{}:{}", address.value, port.value)))
            return put_url("udpmcast", address, port);
        if (!address.value.ends_with(".255")) return put_url("udpout", address, port);
        note(section, address, "converted as a broadcast address; udpout:// would send to one machine");
        return put_url("udpbcast", address, port);
    }

    SetupResult<void> read_tcp(const IniSection& section) {
        const auto* address = section.find("Address");
        const auto* port = section.find("Port");
        if (address == nullptr || port == nullptr)
            return bad(section.line,
                       fmt::format("[{}] has no {}", shown(section.name), address == nullptr ? "Address" : "Port"));
        if (const auto* retry = section.find("RetryTimeout"))
            note(section, *retry,
                 retry->value == "0" ? "a lost connection is always opened again"
                                     : "a lost connection is opened again after 100 ms; the delay doubles up to 5 s");
        return put_url("tcpout", *address, *port);
    }

    SetupResult<void> put_url(std::string_view scheme, const IniEntry& address, const IniEntry& port) {
        if (const auto good = endpoint::parse_port(port.value); !good || *good == 0)
            return bad(port.line, fmt::format("Port: {} is not a port from 1 to 65535", in_quotes(port.value)));
        const auto host = endpoint::parse_host(address.value, scheme, port.value);
        if (!host) return bad(address.line, fmt::format("Address: {}", host.error().text));
        const auto url = fmt::format("{}://{}:{}", scheme, address.value, port.value);
        if (const auto good = endpoint::parse_endpoint(url); !good)
            return bad(address.line, fmt::format("Address: {}", good.error().text));
        put_key("url", toml_string(url));
        return {};
    }

    SetupResult<void> read_filter(const IniSection& section, const FilterOption& option) {
        std::vector<std::string> terms;
        for (const auto& kind : filter_kinds) {
            const auto* entry = section.find(fmt::format("{}{}{}", option.action, kind.word, option.direction));
            // For UDP endpoints, `Filter` is the former name of AllowMsgIdOut.
            if (entry == nullptr && option.option == "out_allow" && kind.word == "MsgId") entry = udp_filter(section);
            if (entry == nullptr) continue;
            const auto ids = numbers(*entry, 0, kind.most);
            if (!ids) return tl::unexpected(ids.error());
            for (const auto id : *ids) terms.push_back(fmt::format("\"{}{}\"", kind.prefix, id));
        }
        if (!terms.empty()) put_key(option.option, fmt::format("[{}]", fmt::join(terms, ", ")));
        return {};
    }

    static const IniEntry* udp_filter(const IniSection& section) {
        return same_letters(heading(section).first, "UdpEndpoint") ? section.find("Filter") : nullptr;
    }

    // ---- values -----------------------------------------------------------------------------------------------------

    SetupResult<std::uint64_t> number(const IniSection& section, std::string_view key, std::uint64_t least,
                                      std::uint64_t most, std::uint64_t otherwise) const {
        const auto* entry = section.find(key);
        if (entry == nullptr) return otherwise;
        const auto value = endpoint::parse_integer(entry->value, least, most);
        if (!value) return bad(entry->line, fmt::format("{}: {}", entry->key, value.error().text));
        return *value;
    }

    SetupResult<std::vector<std::uint64_t>> numbers(const IniEntry& entry, std::uint64_t least,
                                                    std::uint64_t most) const {
        std::vector<std::uint64_t> values;
        std::string_view rest = entry.value;
        for (;;) {
            const auto comma = rest.find(',');
            const auto value = endpoint::parse_integer(trimmed(rest.substr(0, comma)), least, most);
            if (!value) return bad(entry.line, fmt::format("{}: {}", entry.key, value.error().text));
            values.push_back(*value);
            if (comma == std::string_view::npos) return values;
            rest = rest.substr(comma + 1);
        }
    }

    void find_taken_ports() {
        for (const auto& section : sections_)
            if (const auto* port = section.find("Port");
                port != nullptr && same_letters(heading(section).first, "UdpEndpoint"))
                if (const auto value = endpoint::parse_port(port->value)) taken_ports_.push_back(*value);
    }

    std::uint64_t take_free_port() {
        std::uint64_t port = first_udp_port;
        while (std::ranges::find(taken_ports_, port) != taken_ports_.end()) ++port;
        taken_ports_.push_back(port);
        return port;
    }

    std::string unique_name(std::string_view wanted) {
        std::string name(wanted);
        for (int n = 2; std::ranges::find(names_, name) != names_.end(); ++n) name = fmt::format("{}-{}", wanted, n);
        names_.push_back(name);
        return name;
    }

    // ---- unknown keys -----------------------------------------------------------------------------------------------

    void note_unknown_endpoint_keys(const IniSection& section, std::span<const std::string_view> own) {
        std::vector<std::string> filters;
        for (const auto& option : filter_options)
            for (const auto& kind : filter_kinds)
                filters.push_back(fmt::format("{}{}{}", option.action, kind.word, option.direction));
        std::vector<std::string_view> known(own.begin(), own.end());
        known.emplace_back("Group");
        known.insert(known.end(), filters.begin(), filters.end());
        note_unknown_keys(section, known);
    }

    void note_unknown_keys(const IniSection& section, std::span<const std::string_view> known) {
        for (const auto& entry : section.entries)
            if (std::ranges::none_of(known, [&](std::string_view key) { return same_letters(key, entry.key); }))
                note(section, entry,
                     fmt::format("mavlink-router documents no such key{}", did_you_mean(entry.key, known)));
    }

    struct Server {
        std::string_view address, port, section;
        std::uint32_t line;
    };

    std::string_view file_;
    const std::vector<IniSection>& sections_;
    std::vector<Server> servers_;
    std::string toml_;
    std::vector<ConversionNote> notes_;
    std::uint64_t tcp_port_ = default_tcp_port;
    std::vector<std::uint64_t> taken_ports_;
    std::vector<std::string> names_;
};

}  // namespace

SetupResult<Conversion> convert_mavlink_router(std::string_view text, std::string_view file_name) {
    const auto sections = parse_ini(text, file_name);
    if (!sections) return tl::unexpected(sections.error());
    return Converter(file_name, *sections).convert();
}

SetupResult<Conversion> convert_mavlink_router_file(const std::filesystem::path& file) {
    auto text = read_config_text(file);
    if (!text) return tl::unexpected(std::move(text.error()));
    return convert_mavlink_router(*text, file.string());
}

}  // namespace mavloom::config
