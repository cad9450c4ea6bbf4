// SPDX-License-Identifier: MIT
// For -DMAVLOOM_MINIMAL=ON: a program without the page.
#include "page/web_beside.hpp"

namespace mavloom::app {

SetupResult<std::unique_ptr<WebBeside>> WebBeside::open(const Common&, const dialect::Dialect&,
                                                        const config::WebConfig& config, const Beside&) {
    if (!config.listen) return std::unique_ptr<WebBeside>();
    return setup_error(SetupCode::usage,
                       "--web, and listen in [web]: this program was built without the page (MAVLOOM_MINIMAL)");
}

}  // namespace mavloom::app
