// SPDX-License-Identifier: MIT
// Any bytes as a configuration of mavlink-router: no crash; what is refused has a message without control characters;
// what comes out is one of ours.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mavloom/config/config.hpp"
#include "mavloom/config/convert.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace mavloom::config;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto conversion = convert_mavlink_router(text, "main.conf");
    if (conversion) {
        if (!parse_config(conversion->toml, "router.toml")) std::abort();
        return 0;
    }
    if (!conversion.error().text.starts_with("main.conf:")) std::abort();
    for (const char c : conversion.error().text)
        if (static_cast<unsigned char>(c) < 0x20) std::abort();
    return 0;
}
