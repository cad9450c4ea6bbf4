// SPDX-License-Identifier: MIT
#include "doctor/port_probe.hpp"

#include <utility>

namespace mavloom::app {

PortProbe::PortProbe(const endpoint::Endpoint& endpoint) {
    const auto& row = endpoint.row();
    if (!endpoint.calls() || row.carrier != endpoint::Carrier::udp || row.cast != endpoint::Cast::one) return;
    const auto to = net::Address::parse(endpoint.address.host, endpoint.address.port);
    if (!to) return;
    auto socket = net::UdpSocket::open(*net::Address::parse(to->is_v4() ? "0.0.0.0" : "::", 0), {});
    if (!socket) return;
    net::SendBatch batch;
    batch.room()[0] = {nullptr, 0};
    batch.add(&*to, 1);
    if (socket->send(batch, 0)) socket_ = std::move(*socket);
}

bool PortProbe::is_refused() {
    while (socket_) {
        const auto failure = socket_->take_failure();
        if (!failure) break;
        is_refused_ = is_refused_ || failure->error == net::IoError::refused;
    }
    return is_refused_;
}

}  // namespace mavloom::app
