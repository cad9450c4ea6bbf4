// SPDX-License-Identifier: MIT
#include "page/web_beside.hpp"

#include <fmt/format.h>

#include <utility>

#include "mavloom/web/server.hpp"
#include "mavloom/web/token.hpp"
#include "page/discovery.hpp"
#include "page/hop_reporter.hpp"
#include "page/ring_serving.hpp"
#include "page/serving.hpp"

namespace mavloom::app {

namespace {

std::vector<HopReporter::Program> programs_of(const WebBeside::Beside& beside) {
    if (beside.page.empty()) return {};
    const auto hint = beside.ring.empty() ? ring_hint(beside.page, "") : std::string();
    return {{beside.page, hint, beside.control}};
}

std::function<void()> counts_of(RingServing* frames) {
    if (frames == nullptr) return {};
    return [frames] { frames->note_counts(); };
}

class ServerBeside : public WebBeside {
public:
    // `frames` is null without a ring.
    ServerBeside(std::unique_ptr<web::Server> server, std::unique_ptr<RingServing> frames, const Beside& beside)
        : server_(std::move(server)),
          frames_(std::move(frames)),
          hops_(hops_to(*server_, counts_of(frames_.get())), programs_of(beside)) {}

private:
    std::unique_ptr<web::Server> server_;
    std::unique_ptr<RingServing> frames_;
    HopReporter hops_;
};

}  // namespace

SetupResult<std::unique_ptr<WebBeside>> WebBeside::open(const Common& common, const dialect::Dialect& dialect,
                                                        const config::WebConfig& config, const Beside& beside) {
    if (!config.listen) return std::unique_ptr<WebBeside>();
    auto token = web::read_token(config.token_file);
    if (!token) return tl::unexpected(std::move(token.error()).within("--web-token-file"));
    const bool has_token = !token->empty();
    auto server = open_server(
        dialect, *config.listen, "--web",
        {.hosts = config.hosts, .hosts_option = "--web-host", .origins = config.origins, .token = std::move(*token)});
    if (!server) return tl::unexpected(std::move(server.error()));
    std::unique_ptr<RingServing> frames;
    if (!beside.ring.empty()) {
        auto opened = RingServing::open(common, dialect, beside.ring, **server, true);
        if (!opened) return tl::unexpected(std::move(opened.error()));
        frames = std::move(*opened);
    } else {
        print_notice(common, "without --ring NAME, the page shows counters only, no messages");
    }
    print_notice(common, fmt::format("open http://{}", place_of((*server)->addresses().front(), has_token)));
    return std::make_unique<ServerBeside>(std::move(*server), std::move(frames), beside);
}

}  // namespace mavloom::app
