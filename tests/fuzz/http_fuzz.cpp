// SPDX-License-Identifier: MIT
// Any bytes as Host and Origin headers, as a target, and as the frames of a WebSocket: no crash; no name but our own is
// allowed; frames are read alike however they are cut, and no message exceeds its limit.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "http/access.hpp"
#include "http/web_socket/frames.hpp"
#include "mavloom/base/text.hpp"

namespace {

using namespace mavloom::http;
using mavloom::ByteSpan;
using mavloom::ByteView;
using mavloom::same_letters;

void check_access(std::string_view text) {
    static const auto local = *mavloom::net::Address::parse("192.0.2.1", 80);
    static Allowed strict({.own_names = false}), any_host({.any_host = true});
    if (strict.has_host(text, local, mavloom::MonoTime{})) {
        const auto name = host_name_in(text);
        const auto address = mavloom::net::Address::parse(name, 80);
        const bool is_ours = text.empty() || same_letters(name, "localhost") ||
                             (address && (address->is_loopback() || address->unmapped() == local));
        if (!is_ours) std::abort();
    }
    const auto host = host_of_origin(text);
    if (!text.empty() && strict.has_origin(text, "localhost") && !(host && same_letters(*host, "localhost")))
        std::abort();
    if (any_host.has_origin(text, text) != text.empty()) std::abort();
    const auto [path, query] = split_target(text);
    if (path.size() + query.size() > text.size() || path.find('?') != std::string_view::npos) std::abort();
}

struct Log : FrameEvents {
    void take_message(ByteView message, Kind kind) override {
        if (message.size() > 300) std::abort();
        add(kind == Kind::text ? 't' : 'b', message);
    }
    void take_ping(ByteView payload) override { add('p', payload); }
    void take_close(std::uint16_t, std::string_view reason) override { all += reason; }
    void take_fault(Ended, std::uint16_t code) override { all += std::to_string(code); }
    void add(char what, ByteView bytes) { (all += what).append(bytes.begin(), bytes.end()); }

    std::string all;
};

std::string read(std::vector<std::uint8_t> bytes, std::size_t step, bool is_client) {
    static const SessionOptions options{.accepts = Accepts::both, .max_message = 300, .max_fragments = 4};
    Log log;
    FrameReader reader(options, is_client, log);
    for (std::size_t i = 0; i < bytes.size(); i += step)
        reader.feed(ByteSpan(bytes).subspan(i, std::min(step, bytes.size() - i)));
    return log.all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    check_access({reinterpret_cast<const char*>(data), size});
    const std::vector<std::uint8_t> bytes(data, data + size);
    for (const bool is_client : {false, true}) {
        const auto whole = read(bytes, size + 1, is_client);
        if (read(bytes, 1, is_client) != whole || read(bytes, 7, is_client) != whole) std::abort();
    }
    return 0;
}
