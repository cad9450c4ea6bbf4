// SPDX-License-Identifier: MIT
// Receives the frames that a vehicle sends. The vehicle opens nothing; its owner implements this interface on sockets,
// a counter or a list.
#pragma once

#include "mavloom/base/ids.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::sim {

class Sink {
public:
    Sink() = default;
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;
    virtual ~Sink() = default;

    // Takes a whole frame for one link. Frames of a link leave in the order of these calls. The view is valid only
    // during the call.
    virtual void send(LinkId link, const wire::FrameView& frame) = 0;
    // False while much waits for the link: bulk transfers (parameters, files, logs) pause.
    [[nodiscard]] virtual bool has_room(LinkId link) const = 0;
};

}  // namespace mavloom::sim
