// SPDX-License-Identifier: MIT
// Reports when a host on a network of this machine stops answering, or answers again. The kernel finds that out by ARP
// or neighbour discovery while somebody sends to the host, and announces it by rtnetlink(7). No privilege is needed.
// One thread at a time; a NeighbourWatch allocates when opened, and for more changes at once than before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/net/address.hpp"
#include "mavloom/net/fd.hpp"

namespace mavloom::net {

class NeighbourWatch {
public:
    struct Change {
        Address host;  // port 0; a link-local IPv6 address has its interface as scope
        std::uint32_t interface = 0;
        bool answers = false;
    };

    NeighbourWatch() noexcept = default;
    [[nodiscard]] static SetupResult<NeighbourWatch> open();

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(fd_); }
    // Reads the announcements that wait, up to 256, and returns the changes that they contain, often none. Valid until
    // the next call. If the kernel's buffer was full, some changes are missing.
    [[nodiscard]] std::span<const Change> read();

    // Adds the changes that the kernel's datagram announces. Public for the tests.
    static void parse(ByteView datagram, std::vector<Change>& changes);

private:
    Fd fd_;
    std::vector<std::uint8_t> buffer_;
    std::vector<Change> changes_;
};

// Returns the index of the interface by which the kernel sends to `host`; 0 if there is no route. `from`: the sender's
// address, or 0.0.0.0 or ::. `bound`: the interface to which the sender is bound, or 0.
[[nodiscard]] std::uint32_t interface_to(const Address& host, const Address& from, std::uint32_t bound) noexcept;
// Makes the kernel look for a host on the network of this interface: sends an empty datagram to the host's port 9, that
// of the discard protocol (RFC 863). Errors are ignored.
void look_for(const Address& host, std::uint32_t interface) noexcept;

}  // namespace mavloom::net
