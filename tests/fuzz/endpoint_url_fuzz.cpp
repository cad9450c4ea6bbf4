// SPDX-License-Identifier: MIT
// Any bytes as an endpoint: no crash; what is refused has a message without control characters; what is taken has a
// label that is taken again.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mavloom/endpoint/endpoint.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace mavloom::endpoint;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    (void)parse_duration(text);
    (void)parse_size(text);
    const auto endpoint = parse_endpoint(text);
    if (!endpoint) {
        if (endpoint.error().text.empty() || endpoint.error().code != mavloom::SetupCode::usage) std::abort();
        for (const char c : endpoint.error().text)
            if (static_cast<unsigned char>(c) < 0x20) std::abort();
        return 0;
    }
    const bool has_address = !endpoint->address.host.empty();
    if (has_address && endpoint->options.name.empty()) {
        const auto again = parse_endpoint(endpoint->label());
        if (!again || again->address != endpoint->address || again->scheme != endpoint->scheme) std::abort();
    }
    return 0;
}
