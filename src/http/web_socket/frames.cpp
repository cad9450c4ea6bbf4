// SPDX-License-Identifier: MIT
#include "http/web_socket/frames.hpp"

#include <sys/random.h>

#include <algorithm>
#include <boost/beast/websocket/detail/utf8_checker.hpp>
#include <cerrno>
#include <cstring>

namespace mavloom::http {

namespace {

constexpr std::uint8_t final_bit = 0x80, reserved_bits = 0x70, mask_bit = 0x80, length_bits = 0x7f;
constexpr int longest_control = 125;

bool is_utf8(ByteView text) {
    return text.empty() ||
           boost::beast::websocket::detail::check_utf8(reinterpret_cast<const char*>(text.data()), text.size());
}

bool may_be_sent(std::uint16_t code) {
    return (code >= 1000 && code <= 1003) || (code >= 1007 && code <= 1014) || (code >= 3000 && code <= 4999);
}

// Applies the mask, whose byte `at` is the next, and returns the byte after the last used.
std::size_t apply_mask(ByteSpan bytes, const std::array<std::uint8_t, 4>& mask, std::size_t at) noexcept {
    std::array<std::uint8_t, 8> twice{};
    for (std::size_t i = 0; i < twice.size(); ++i) twice[i] = mask[(at + i) % 4];
    const auto word = load_le<std::uint64_t>(twice.data());
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) store_le(&bytes[i], load_le<std::uint64_t>(&bytes[i]) ^ word);
    for (; i < bytes.size(); ++i) bytes[i] ^= twice[i % 8];
    return (at + bytes.size()) % 4;
}

}  // namespace

void fill_randomly(ByteSpan bytes) {
    while (::getrandom(bytes.data(), bytes.size(), 0) < 0 && errno == EINTR) continue;
}

void FrameReader::feed(ByteSpan bytes) {
    while (!bytes.empty() && !is_over_) {
        const std::size_t taken = is_in_payload_ ? take_payload(bytes) : take_header(bytes);
        bytes = bytes.subspan(taken);
    }
}

std::size_t FrameReader::header_size() const noexcept {
    const auto short_length = header_[1] & length_bits;
    const std::size_t more = short_length == 127 ? 8 : short_length == 126 ? 2 : 0;
    return 2 + more + ((header_[1] & mask_bit) != 0 ? 4 : 0);
}

std::uint64_t FrameReader::length() const noexcept {
    const auto short_length = header_[1] & length_bits;
    if (short_length < 126) return short_length;
    std::uint64_t length = 0;
    for (std::size_t i = 0; i < (short_length == 126 ? 2u : 8u); ++i) length = length << 8 | header_[2 + i];
    return length;
}

std::size_t FrameReader::take_header(ByteView bytes) {
    std::size_t taken = 0;
    while (taken < bytes.size() && (header_have_ < 2 || header_have_ < header_size()))
        header_[header_have_++] = bytes[taken++];
    if (header_have_ >= 2 && header_have_ == header_size()) begin_frame();
    return taken;
}

void FrameReader::begin_frame() {
    if (!has_valid_header()) return fail(Ended::protocol, close_code::protocol);
    if (!is_control() && !begin_data()) return;
    if (!is_client_) std::memcpy(mask_.data(), &header_[header_have_ - 4], mask_.size());
    left_ = length();
    header_have_ = mask_at_ = 0;
    is_in_payload_ = left_ != 0;
    if (!is_in_payload_) end_frame({});
}

bool FrameReader::has_valid_header() const noexcept {
    const bool is_masked = (header_[1] & mask_bit) != 0;
    const auto short_length = header_[1] & length_bits;
    const bool is_shortest = short_length < 126 || length() >= (short_length == 126 ? 126 : 65'536);
    if ((header_[0] & reserved_bits) != 0 || is_masked == is_client_ || !is_shortest || length() >> 63 != 0)
        return false;
    if (is_control()) return opcode() <= Opcode::pong && is_final() && short_length <= longest_control;
    return opcode() <= Opcode::binary && (opcode() == Opcode::continuation) == is_in_message_;
}

bool FrameReader::begin_data() {
    if (!is_in_message_) {
        kind_ = opcode() == Opcode::text ? Kind::text : Kind::binary;
        fragments_ = 0;
        message_.clear();
        is_in_message_ = true;
    }
    const bool is_accepted = options_.accepts == Accepts::both ||
                             (options_.accepts == Accepts::text) == (kind_ == Kind::text);
    if (!is_accepted) fail(Ended::kind, close_code::wrong_kind);
    else if (++fragments_ > options_.max_fragments) fail(Ended::fragments, close_code::policy);
    else if (length() > options_.max_message - message_.size()) fail(Ended::size, close_code::too_big);
    return !is_over_;
}

// A payload that arrived at once is not copied.
std::size_t FrameReader::take_payload(ByteSpan bytes) {
    const auto part = bytes.first(static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes.size())));
    if (!is_client_) mask_at_ = apply_mask(part, mask_, mask_at_);
    left_ -= part.size();
    if (left_ == 0) {
        is_in_payload_ = false;
        end_frame(part);
    } else {
        auto& to = is_control() ? control_ : message_;
        to.insert(to.end(), part.begin(), part.end());
    }
    return part.size();
}

void FrameReader::end_frame(ByteView last_part) {
    if (is_control()) return end_control(last_part);
    if (is_final() && message_.empty()) return end_message(last_part);
    message_.insert(message_.end(), last_part.begin(), last_part.end());
    if (is_final()) end_message(message_);
}

void FrameReader::end_message(ByteView message) {
    is_in_message_ = false;
    if (kind_ == Kind::text && !is_utf8(message)) return fail(Ended::protocol, close_code::bad_text);
    events_.take_message(message, kind_);
}

void FrameReader::end_control(ByteView last_part) {
    if (!control_.empty()) control_.insert(control_.end(), last_part.begin(), last_part.end());
    const ByteView payload = control_.empty() ? last_part : ByteView(control_);
    if (opcode() == Opcode::ping) events_.take_ping(payload);
    if (opcode() == Opcode::close) end_close(payload);
    control_.clear();
}

void FrameReader::end_close(ByteView payload) {
    const std::uint16_t code = payload.size() < 2 ? 0 : static_cast<std::uint16_t>(payload[0] << 8 | payload[1]);
    const auto reason = payload.subspan(std::min<std::size_t>(payload.size(), 2));
    if (payload.size() == 1 || (payload.size() >= 2 && !may_be_sent(code)))
        return fail(Ended::protocol, close_code::protocol);
    if (!is_utf8(reason)) return fail(Ended::protocol, close_code::bad_text);
    is_over_ = true;
    events_.take_close(code, {reinterpret_cast<const char*>(reason.data()), reason.size()});
}

void FrameReader::fail(Ended why, std::uint16_t code) {
    is_over_ = true;
    events_.take_fault(why, code);
}

void FrameWriter::append(std::vector<std::uint8_t>& to, Opcode opcode, ByteView payload) {
    begin(to, opcode, payload.size());
    to.insert(to.end(), payload.begin(), payload.end());
    end(to);
}

void FrameWriter::begin(std::vector<std::uint8_t>& to, Opcode opcode, std::size_t size) {
    const std::size_t bytes = size < 126 ? 0 : size < 65'536 ? 2 : 8;
    const auto short_length = static_cast<std::uint8_t>(bytes == 0 ? size : bytes == 2 ? 126 : 127);
    to.push_back(static_cast<std::uint8_t>(final_bit | static_cast<std::uint8_t>(opcode)));
    to.push_back(static_cast<std::uint8_t>(short_length | (is_client_ ? mask_bit : 0)));
    for (std::size_t i = bytes; i-- > 0;) to.push_back(static_cast<std::uint8_t>(size >> (8 * i)));
    if (is_client_) append_mask(to);
    payload_at_ = to.size();
}

void FrameWriter::append_mask(std::vector<std::uint8_t>& to) {
    if (random_used_ == random_.size()) {
        fill_randomly(random_);
        random_used_ = 0;
    }
    const auto mask = ByteView(random_).subspan(random_used_, 4);
    random_used_ += 4;
    to.insert(to.end(), mask.begin(), mask.end());
}

void FrameWriter::end(std::vector<std::uint8_t>& to) {
    if (!is_client_) return;
    std::array<std::uint8_t, 4> mask{};
    std::memcpy(mask.data(), &to[payload_at_ - 4], mask.size());
    apply_mask(ByteSpan(to).subspan(payload_at_), mask, 0);
}

}  // namespace mavloom::http
