// SPDX-License-Identifier: MIT
#include "page/discovery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <system_error>

#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/net/port_holder.hpp"
#include "mavloom/net/udp.hpp"
#include "mavloom/shm/counter_page.hpp"

namespace mavloom::app {

Running find_running() {
    Running running;
    for (const auto& name : shm::ring_names())
        if (auto ring = shm::ring_status(name); ring && ring->writer_alive && !ring->damaged && !ring->retired)
            running.rings.push_back(std::move(*ring));
    for (const auto& name : shm::counter_page_names()) {
        const auto page = shm::read_counters(name, {.user = link::Links::owner_of_inlets()});
        if (page && page->owner_alive &&
            std::ranges::find(running.rings, name, &shm::RingStatus::name) == running.rings.end())
            running.without_ring.push_back(name);
    }
    return running;
}

static std::vector<std::string> devices_in(const std::filesystem::path& folder, std::string_view prefix) {
    std::vector<std::string> found;
    std::error_code failed;
    for (std::filesystem::directory_iterator file(folder, failed), end; !failed && file != end; file.increment(failed))
        if (file->path().filename().string().starts_with(prefix)) found.push_back(file->path().string());
    std::ranges::sort(found);
    return found;
}

std::vector<std::string> serial_ports() {
    if (auto named = devices_in("/dev/serial/by-id", ""); !named.empty()) return named;
    auto all = devices_in("/dev", "ttyACM");
    for (auto& usb : devices_in("/dev", "ttyUSB")) all.push_back(std::move(usb));
    return all;
}

std::string serial_hint() {
    constexpr std::size_t most = 4;
    const auto ports = serial_ports();
    if (ports.empty()) return {};
    const std::span some(ports.data(), std::min(ports.size(), most));
    return fmt::format("a vehicle may be at {}: to read it, name the source 'serial://{}?baud=57600'",
                       fmt::join(some, ", "), ports.front());
}

// Where messages of a program without a ring are heard, if others have one.
constexpr std::string_view other_rings = "a program that has one";

std::string ring_hint(const std::string& program, std::string_view port) {
    if (port.empty())
        return fmt::format("{0} has no ring, so its messages are not shown: start it with --ring {0}", program);
    return fmt::format(
        "{0} has no ring, so only those of its messages are shown that it sends to {1}: to see all, start "
        "it with --ring {0}",
        program, port);
}

std::vector<std::string> lines_of(const Running& running, std::string_view port) {
    std::vector<std::string> lines;
    lines.reserve(running.rings.size() + running.without_ring.size());
    for (const auto& ring : running.rings)
        lines.push_back(fmt::format("found the ring {} of process {}", ring.name, ring.writer_pid));
    const auto where = running.rings.empty() ? port : other_rings;
    for (const auto& name : running.without_ring)
        lines.push_back(fmt::format("found {}, and shows its counters; {}", name, ring_hint(name, where)));
    return lines;
}

SetupResult<void> check_port(std::string_view source) {
    const auto endpoint = endpoint::parse_endpoint(source);
    const auto address = net::Address::parse(endpoint->address.host, endpoint->address.port);
    auto socket = net::UdpSocket::open(*address, {});
    if (socket) return {};
    return net::BindErrors(net::Transport::udp).complete(std::move(socket.error()), *address);
}

SetupResult<Running> find_sources(const Common& common, std::vector<std::string>& sources,
                                  std::initializer_list<std::string_view> usual) {
    if (!sources.empty()) return {};
    auto running = find_running();
    std::vector<std::string> ports;  // those that no other program has
    std::optional<SetupError> first_taken;
    for (const auto port : running.rings.empty() ? usual : std::initializer_list<std::string_view>{}) {
        auto checked = check_port(port);
        if (checked) ports.emplace_back(port);
        else if (port == *usual.begin()) first_taken = std::move(checked.error());
    }
    for (const auto& line : lines_of(running, fmt::format("{}", fmt::join(ports, " or ")))) print_notice(common, line);
    for (const auto& ring : running.rings) sources.push_back("shm://" + ring.name);
    if (!running.rings.empty()) return running;
    if (first_taken) running.port_taken = first_taken->text;
    const auto why = first_taken ? fmt::format("no ring is in use, and {}", first_taken->text) : "no ring is in use";
    if (!ports.empty()) {
        print_notice(common, fmt::format("{}; listening on {}", why, fmt::join(ports, " and ")));
        if (const auto hint = serial_hint(); !hint.empty()) print_notice(common, hint);
        sources = std::move(ports);
        return running;
    }
    if (running.without_ring.empty())
        return setup_error(first_taken->code, why +
                                                  "; end that program, or name another source, such as "
                                                  "udpin://0.0.0.0:14551, and let the vehicle send there");
    print_notice(common, why);
    return running;
}

static bool is_ring_source(const std::string& source) {
    const auto endpoint = endpoint::parse_endpoint(source);
    return endpoint && endpoint->is_ring();
}

std::vector<HopReporter::Program> programs_of(const std::vector<std::string>& sources, const Running& running) {
    std::string places;
    for (const auto& source : sources)
        if (!is_ring_source(source)) places += (places.empty() ? "" : " or ") + source;
    if (places.empty() && !running.rings.empty()) places = other_rings;
    std::vector<HopReporter::Program> programs;
    programs.reserve(running.without_ring.size() + sources.size());
    for (const auto& name : running.without_ring) programs.push_back({name, ring_hint(name, places)});
    for (const auto& source : sources)
        if (is_ring_source(source)) programs.push_back({endpoint::parse_endpoint(source)->path});
    return programs;
}

}  // namespace mavloom::app
