// SPDX-License-Identifier: MIT
// Passes frames that a program writes into a ring to a server of `mavloom web`, on its own threads. Rings come and go.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "command.hpp"
#include "mavloom/feed/receiver.hpp"
#include "mavloom/web/server.hpp"
#include "page/serving.hpp"

namespace mavloom::app {

class RingServing {
public:
    using OnFrame = std::function<void(const wire::FrameView&, WallTime)>;

    // `server` must outlive the object. `on_frame` is called on the object's thread. Notices about the ring are logged
    // if `logs`.
    [[nodiscard]] static SetupResult<std::unique_ptr<RingServing>> open(const Common& common,
                                                                        const dialect::Dialect& dialect,
                                                                        const std::string& ring, web::Server& server,
                                                                        bool logs, OnFrame on_frame = {});
    ~RingServing();
    RingServing(const RingServing&) = delete;
    RingServing& operator=(const RingServing&) = delete;

    void note_counts() { serving_.note_counts(); }

private:
    RingServing(std::unique_ptr<feed::Receiver> receiver, const Common& common, web::Server& server, OnFrame on_frame);

    std::unique_ptr<feed::Receiver> receiver_;
    ServerAudience audience_;
    Serving serving_;
    std::thread thread_;
};

}  // namespace mavloom::app
