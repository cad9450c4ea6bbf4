// SPDX-License-Identifier: MIT
// The suite of all transports, over WebSockets.
#include "mavloom/ws/transport.hpp"
#include "unit/link/transport_suite.hpp"

namespace mavloom::link::testing {

// Registers the schemes before any endpoint is opened.
static const bool is_registered = [] {
    ws::register_transports();
    return true;
}();

INSTANTIATE_TEST_SUITE_P(Loopback, LinksTransport,
                         ::testing::Values(Pair{"wsin", "wsout", "127.0.0.1"}, Pair{"wsin", "wsout", "[::1]"},
                                           Pair{"wsin", "wsout", "localhost"}),
                         name_of);

}  // namespace mavloom::link::testing
