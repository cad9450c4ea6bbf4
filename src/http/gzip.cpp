// SPDX-License-Identifier: MIT
#include "mavloom/http/gzip.hpp"

#include <boost/beast/zlib/inflate_stream.hpp>
#include <boost/crc.hpp>
#include <cstddef>
#include <cstdint>

#include "mavloom/base/bytes.hpp"

namespace mavloom::http {

namespace {

namespace zlib = boost::beast::zlib;

// RFC 1952, section 2.3. The trailer has the content's CRC-32 and size.
constexpr std::string_view member_start("\x1f\x8b\x08\0", 4);  // deflate, and no flag
constexpr std::size_t header_size = 10, trailer_size = 8;
constexpr std::size_t largest_ratio = 1032;  // of deflate: 258 bytes for two bits

bool inflate(std::string_view compressed, std::string& content) {
    zlib::z_params step;
    step.next_in = compressed.data();
    step.avail_in = compressed.size();
    step.next_out = content.data();
    step.avail_out = content.size();
    zlib::inflate_stream stream;
    boost::beast::error_code error;
    stream.write(step, zlib::Flush::finish, error);
    return error == zlib::error::end_of_stream && step.avail_in == 0 && step.avail_out == 0;
}

std::uint32_t checksum(std::string_view content) {
    boost::crc_32_type crc;
    crc.process_bytes(content.data(), content.size());
    return crc.checksum();
}

}  // namespace

std::optional<std::string> gunzip(std::string_view compressed) {
    if (compressed.size() < header_size + trailer_size || !compressed.starts_with(member_start)) return std::nullopt;
    const char* const trailer = compressed.data() + compressed.size() - trailer_size;
    compressed.remove_prefix(header_size);
    compressed.remove_suffix(trailer_size);
    const std::size_t size = load_le<std::uint32_t>(trailer + 4);
    if (size / largest_ratio > compressed.size()) return std::nullopt;  // before it is allocated
    std::string content(size, '\0');
    if (!inflate(compressed, content) || checksum(content) != load_le<std::uint32_t>(trailer)) return std::nullopt;
    return content;
}

}  // namespace mavloom::http
