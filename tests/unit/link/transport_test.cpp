// SPDX-License-Identifier: MIT
// The suite of all transports, over those of `link` itself. Module ws runs it over WebSockets.
#include "unit/link/transport_suite.hpp"

namespace mavloom::link::testing {

INSTANTIATE_TEST_SUITE_P(Loopback, LinksTransport,
                         ::testing::Values(Pair{"udpin", "udpout", "127.0.0.1"}, Pair{"tcpin", "tcpout", "127.0.0.1"},
                                           Pair{"udpin", "udpout", "[::1]"}, Pair{"tcpin", "tcpout", "[::1]"},
                                           Pair{"udpin", "udpout", "localhost"}, Pair{"tcpin", "tcpout", "localhost"}),
                         name_of);

}  // namespace mavloom::link::testing
