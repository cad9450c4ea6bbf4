// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "output.hpp"
#include "parts.hpp"
#include "status_text.hpp"

namespace mavloom::app::shm_parts {

namespace {

struct StatOptions {
    std::string name;
    bool json = false;
};

Exit stat(const StatOptions& options) {
    const auto ring = shm::ring_status(options.name);
    if (!ring) return fail(ring.error());
    return print_at_end(options.json ? line_of(json_of(*ring)) : details_of(*ring), Exit::done);
}

}  // namespace

Run declare_stat(Arguments part, const Common&) {
    auto options = std::make_shared<StatOptions>();
    add_name(part, options->name);
    add_json(part, options->json);
    return [options] { return stat(*options); };
}

}  // namespace mavloom::app::shm_parts
