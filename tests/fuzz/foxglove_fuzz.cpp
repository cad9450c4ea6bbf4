// SPDX-License-Identifier: MIT
// Any text as a request of a Foxglove client: no crash, and no more ids than the text has room for.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "web/clients/foxglove.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto request = mavloom::web::foxglove::parse({reinterpret_cast<const char*>(data), size});
    if (request && request->subscribe.size() + request->unsubscribe.size() > size / 2) std::abort();
    return 0;
}
