// SPDX-License-Identifier: MIT
// A connection that is not request and answer any more: a WebSocket or a stream. Http thread only.
#pragma once

namespace mavloom::http {

class OpenSession {
public:
    OpenSession() = default;
    OpenSession(const OpenSession&) = delete;
    OpenSession& operator=(const OpenSession&) = delete;
    virtual ~OpenSession() = default;
    // Ends the connection at once. Nothing is called back any more.
    virtual void abandon() = 0;
    // Ends the connection at once, and reports that if the session has not ended yet.
    virtual void cut() = 0;
    // It only waits for its peer.
    [[nodiscard]] virtual bool is_closing() const = 0;
};

}  // namespace mavloom::http
