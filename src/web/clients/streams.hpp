// SPDX-License-Identifier: MIT
// The clients of /api/v1/stream: which messages each wants, and their lines of JSON, as `mavloom listen --json` prints
// them. Private to module web; the caller serializes all calls.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <unordered_map>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/dialect/filter.hpp"
#include "mavloom/dialect/rate_limiter.hpp"
#include "mavloom/http/session.hpp"
#include "mavloom/message/format.hpp"
#include "mavloom/observe/heard.hpp"
#include "web/clients/drops.hpp"

namespace mavloom::web {

struct StreamTerms {
    dialect::Filter filter;
    dialect::Rates max_rate;
};

// The terms in "only=ATTITUDE,GPS_RAW_INT&from=1/1&max_rate=*:5". Each may be left out. Pure. Errors are `usage`.
[[nodiscard]] SetupResult<StreamTerms> parse_stream_terms(const dialect::Dialect& dialect, std::string_view query);

class Streams {
public:
    explicit Streams(const dialect::Dialect& dialect) : dialect_(dialect), json_(dialect) {}

    void add(const std::shared_ptr<http::Session>& session, const StreamTerms& terms);
    void remove(const http::Session& session);
    void publish(const observe::Heard& heard);
    // Lets the writers send what was queued.
    void flush(MonoTime now);

private:
    struct Stream {
        std::shared_ptr<http::Session> session;
        dialect::Filter filter;
        dialect::RateLimiter<MonoTime> limiter;
        Drops drops{};
        bool has_new = false;
    };

    const dialect::Dialect& dialect_;
    const message::JsonFormatter json_;
    std::unordered_map<const http::Session*, std::unique_ptr<Stream>> all_;
    message::TextBuffer line_;
};

}  // namespace mavloom::web
