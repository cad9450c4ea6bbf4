// SPDX-License-Identifier: MIT
// The server of `mavloom web` beside a router or a simulator, in the same process. It reads that program's ring and its
// counter page on threads of its own, so the program's own thread does nothing for it.
#pragma once

#include <memory>
#include <string>

#include "command.hpp"
#include "mavloom/config/config.hpp"

namespace mavloom::app {

// Serves until it is destroyed.
class WebBeside {
public:
    // The names of the program's counter page, of its ring and of its control socket. Each is empty if there is none.
    struct Beside {
        std::string page, ring, control;
    };

    // Null if `config` has no place. Open it after the ring. Logs where the page is.
    [[nodiscard]] static SetupResult<std::unique_ptr<WebBeside>> open(const Common& common,
                                                                      const dialect::Dialect& dialect,
                                                                      const config::WebConfig& config,
                                                                      const Beside& beside);
    virtual ~WebBeside() = default;
};

}  // namespace mavloom::app
