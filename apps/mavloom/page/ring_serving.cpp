// SPDX-License-Identifier: MIT
#include "page/ring_serving.hpp"

#include <utility>

#include "mavloom/base/thread.hpp"

namespace mavloom::app {

SetupResult<std::unique_ptr<RingServing>> RingServing::open(const Common& common, const dialect::Dialect& dialect,
                                                            const std::string& ring, web::Server& server, bool logs,
                                                            OnFrame on_frame) {
    auto receiver = feed::Receiver::create(dialect, feed::Receiver::default_buffer_bytes,
                                           [&common, logs](std::string_view text) {
                                               if (logs) print_event(common, text);
                                           });
    if (!receiver) return tl::unexpected(std::move(receiver.error()));
    if (auto added = (*receiver)->add(*endpoint::parse_endpoint("shm://" + ring)); !added)
        return tl::unexpected(std::move(added.error()));
    (*receiver)->start(MonoTime::max(), Serving::rest);
    return std::unique_ptr<RingServing>(new RingServing(std::move(*receiver), common, server, std::move(on_frame)));
}

RingServing::RingServing(std::unique_ptr<feed::Receiver> receiver, const Common& common, web::Server& server,
                         OnFrame on_frame)
    : receiver_(std::move(receiver)),
      audience_(server),
      serving_(common, {.on_frame = std::move(on_frame)}, *receiver_, audience_) {
    thread_ = thread_without_signals([this, &common] {
        serving_.run();
        if (const auto* const error = receiver_->error()) print_event(common, error->text);
    });
}

RingServing::~RingServing() {
    receiver_->stop();
    thread_.join();
}

}  // namespace mavloom::app
