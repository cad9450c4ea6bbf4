// SPDX-License-Identifier: MIT
#include "status_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "mavloom/base/counted.hpp"
#include "mavloom/base/shown.hpp"

namespace mavloom::app::shm_parts {

namespace {

std::string size_text(std::uint64_t bytes) {
    for (const auto& [shift, unit] : {std::pair(30, "GiB"), std::pair(20, "MiB"), std::pair(10, "KiB")})
        if (bytes >> shift != 0 && bytes % (std::uint64_t{1} << shift) == 0)
            return fmt::format("{} {}", bytes >> shift, unit);
    return counted(bytes, "byte");
}

std::string writer_text(const shm::RingStatus& ring) {
    if (ring.writer_alive)
        return fmt::format("written by process {} ({})", ring.writer_pid, shm::to_text(ring.when_full));
    return ring.writer_pid == 0 ? "no writer" : fmt::format("no writer, process {} was killed", ring.writer_pid);
}

Json json_of(const shm::ReaderStatus& reader) {
    return {{"slot", reader.slot},         {"pid", reader.pid},
            {"program", reader.program},   {"opened_us", unix_us(reader.opened)},
            {"lossless", reader.lossless}, {"holds", reader.holds},
            {"asleep", reader.asleep},     {"behind_bytes", reader.behind_bytes},
            {"missed", reader.missed},     {"behind_records", reader.behind_records}};
}

std::string text_of(const shm::ReaderStatus& reader) {
    return fmt::format("  reader {} {} process {}{}: {}, {} behind, {} missed\n", reader.slot, printable(reader.program),
                       reader.pid, reader.lossless ? (reader.holds ? ", lossless" : ", lossless, evicted") : "",
                       counted(reader.behind_records, "record"), counted(reader.behind_bytes, "byte"), reader.missed);
}

}  // namespace

Json json_of(const shm::RingStatus& ring) {
    Json readers = Json::array();
    for (const auto& reader : ring.readers) readers.push_back(json_of(reader));
    return {{"name", ring.name},
            {"path", ring.path},
            {"owner", ring.owner},
            {"mode", fmt::format("{:04o}", ring.mode)},
            {"capacity", ring.capacity},
            {"created_us", unix_us(ring.created)},
            {"writer_alive", ring.writer_alive},
            {"writer_pid", ring.writer_pid},
            {"writer_opened_us", unix_us(ring.writer_opened)},
            {"writers", ring.writers},
            {"full", shm::to_text(ring.when_full)},
            {"records", ring.records},
            {"bytes", ring.bytes},
            {"dropped", ring.dropped},
            {"evictions", ring.evictions},
            {"retired", ring.retired},
            {"damaged", ring.damaged},
            {"readers", std::move(readers)}};
}

std::string line_of(const Json& object) { return object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

std::string text_of(const shm::RingStatus& ring) {
    return fmt::format("{}  {}, {}, {}, {}\n", ring.name, size_text(ring.capacity), writer_text(ring),
                       counted(ring.readers.size(), "reader"),
                       ring.damaged ? "damaged" : counted(ring.records, "record"));
}

std::string details_of(const shm::RingStatus& ring) {
    auto text = text_of(ring);
    text += fmt::format("  {}, {:04o}, {}\n", ring.path, ring.mode, printable(ring.owner));
    if (ring.damaged) return text;
    text += fmt::format("  {} so far, {} dropped, {}, {}\n", counted(ring.bytes, "byte"), ring.dropped,
                        counted(ring.evictions, "eviction"), counted(ring.writers, "writer"));
    for (const auto& reader : ring.readers) text += text_of(reader);
    return text;
}

}  // namespace mavloom::app::shm_parts
