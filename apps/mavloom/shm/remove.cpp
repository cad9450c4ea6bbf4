// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "mavloom/shm/ring_info.hpp"
#include "parts.hpp"

namespace mavloom::app::shm_parts {

namespace {

struct RemoveOptions {
    std::vector<std::string> names;
    bool force = false;
};

SetupResult<void> remove_one(const RemoveOptions& options, const std::string& name) {
    const auto ring = shm::ring_status(name);
    if (ring && ring->writer_alive && !options.force)
        return setup_error(SetupCode::in_use,
                           fmt::format("ring {} is in use by process {}, which writes it; --force removes it anyway",
                                       name, ring->writer_pid));
    return shm::remove_ring(name);
}

Exit remove(const RemoveOptions& options) {
    Exit status = Exit::done;
    for (const auto& name : options.names)
        if (const auto removed = remove_one(options, name); !removed) status = fail(removed.error());
    return status;
}

}  // namespace

Run declare_remove(Arguments part, const Common&) {
    auto options = std::make_shared<RemoveOptions>();
    part.add_option("NAME", "NAME", options->names, "the rings").required();
    part.add_flag("--force", options->force, "also if a process still writes the ring");
    return [options] { return remove(*options); };
}

}  // namespace mavloom::app::shm_parts
