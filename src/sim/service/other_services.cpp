// SPDX-License-Identifier: MIT
#include "sim/service/other_services.hpp"

#include "sim/command/positions.hpp"
#include "sim/control/controls.hpp"
#include "sim/parts.hpp"
#include "sim/payload/traffic.hpp"
#include "sim/service/connection.hpp"
#include "sim/service/shell.hpp"
#include "sim/telemetry/data_streams.hpp"

namespace mavloom::sim {

std::vector<std::unique_ptr<Service>> make_other_services(Parts& parts) {
    std::vector<std::unique_ptr<Service>> services;
    services.push_back(
        std::make_unique<Controls>(parts.firmware, parts.parameters, parts.flight, parts.radio, parts,
                                   [&parts](const GeoPoint& origin) { (void)set_global_origin(parts, origin); }));
    services.push_back(std::make_unique<Shell>(parts.firmware, parts.options.limits.clients, parts.radio));
    if (parts.options.traffic != 0)
        services.push_back(std::make_unique<Traffic>(parts.options, parts.radio, parts.streams, parts.now.flight));
    services.push_back(
        std::make_unique<Connection>(parts.booted, parts.flight, parts.radio, parts.streams, parts.announcer));
    services.push_back(std::make_unique<DataStreams>(parts.firmware, parts.streams));
    return services;
}

}  // namespace mavloom::sim
