// SPDX-License-Identifier: MIT
#include "record/foreign_file.hpp"

#include <algorithm>

#include "mavloom/wire/frame_checksum.hpp"

namespace mavloom::record {
namespace {

using namespace std::string_view_literals;

struct Signature {
    std::string_view bytes;  // at the start of the file
    ForeignFormat format;
};

constexpr std::string_view dataflash_advice =
    "read it with pymavlink (mavlogdump.py FILE), or download the telemetry log of the flight";
constexpr std::string_view pcap_advice = "extract the UDP payloads first, for example with tshark";
constexpr std::string_view unpack_advice = "unpack it first";

// At least three bytes, so that a damaged tlog is hardly ever taken for one. Sources: the formats' own specifications.
constexpr Signature signatures[] = {
    {"\xa3\x95\x80"sv, {"a DataFlash log of ArduPilot", dataflash_advice}},
    {"FMT, "sv, {"a DataFlash log of ArduPilot as text", dataflash_advice}},
    {"ULog\x01\x12\x35"sv, {"a ULog of PX4", "read it with pyulog (ulog_info FILE)"}},
    {"\x1f\x8b\x08"sv, {"a gzip file", "unpack it first, with gunzip"}},
    {"\xfd"
     "7zXZ\0"sv,
     {"an xz file", unpack_advice}},
    {"BZh"sv, {"a bzip2 file", unpack_advice}},
    {"\x28\xb5\x2f\xfd"sv, {"a zstd file", unpack_advice}},
    {"PK\x03\x04"sv, {"a zip file", unpack_advice}},
    {"\xd4\xc3\xb2\xa1"sv, {"a pcap capture", pcap_advice}},
    {"\xa1\xb2\xc3\xd4"sv, {"a pcap capture", pcap_advice}},
    {"\x4d\x3c\xb2\xa1"sv, {"a pcap capture", pcap_advice}},
    {"\xa1\xb2\x3c\x4d"sv, {"a pcap capture", pcap_advice}},
    {"\x0a\x0d\x0d\x0a"sv, {"a pcapng capture", pcap_advice}},
    {"\x89MCAP0\r\n"sv, {"an MCAP file", "read it with the package mcap"}},
    {"#ROSBAG V2.0"sv, {"a ROS bag", "read it with the package rosbags"}},
    {"PAR1"sv, {"a Parquet file", "read it with pyarrow"}},
    {"SQLite format 3\0"sv, {"an SQLite database", "read it with Python's sqlite3"}},
    {"\x89HDF\r\n\x1a\n"sv, {"an HDF5 file", "read it with the package h5py"}},
};

// Returns the length of an intact frame of known id at the front; 0 if there is none.
std::size_t intact_frame(ByteView bytes, const wire::MessageTable& table) noexcept {
    const auto length = wire::frame_length(bytes);
    if (length == 0 || length > bytes.size()) return 0;
    const auto frame = wire::FrameView::unchecked(bytes.first(length));
    const auto* info = table.find(frame.id());
    if (info == nullptr) return 0;
    const auto checksum = wire::crc_update(wire::checksum_before_extra(frame), info->crc_extra);
    return checksum == frame.checksum() ? length : 0;
}

// Whether two frames follow each other at the front, or one fills all bytes.
bool is_stream(ByteView bytes, const wire::MessageTable& table) noexcept {
    const auto first = intact_frame(bytes, table);
    return first != 0 && (first == bytes.size() || intact_frame(bytes.subspan(first), table) != 0);
}

constexpr bool is_text(std::uint8_t byte) noexcept {
    return (byte >= 0x20 && byte < 0x7f) || byte == '\t' || byte == '\n' || byte == '\r';
}

// Text has no signature. A record begins with a zero byte, so text holds none. 4096 bytes of it are more than damage.
std::optional<ForeignFormat> text_format(ByteView first_bytes) noexcept {
    if (first_bytes.empty() || !std::ranges::all_of(first_bytes, is_text)) return std::nullopt;
    if (first_bytes[0] == '{' || first_bytes[0] == '[') return ForeignFormat{"JSON", "read it with Python's json"};
    return ForeignFormat{"text", "if it is CSV, read it with Python's csv or with pandas.read_csv"};
}

}  // namespace

std::optional<ForeignFormat> foreign_format(ByteView first_bytes, const wire::MessageTable& table) noexcept {
    const std::string_view text(reinterpret_cast<const char*>(first_bytes.data()), first_bytes.size());
    const auto* found = std::ranges::find_if(signatures, [&](const auto& one) { return text.starts_with(one.bytes); });
    if (found != std::end(signatures)) return found->format;
    if (is_stream(first_bytes, table))
        return ForeignFormat{"a MAVLink stream without times", "in Python, mavloom.Parser().feed() reads its bytes"};
    return text_format(first_bytes);
}

}  // namespace mavloom::record
