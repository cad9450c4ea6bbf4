// SPDX-License-Identifier: MIT
// What the links of an endpoint need from their dialect: the table for finding frames, and the rules for queueing them.
// Private to module link; single owner thread.
#pragma once

#include <map>

#include "link/core/queue_rules.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::link::detail {

struct LinkDialect {
    explicit LinkDialect(const dialect::Dialect& dialect) : table(dialect.wire_table()), queue_rules(dialect) {}

    const wire::MessageTable& table;
    QueueRules queue_rules;
};

// The dialect of each endpoint: its own if it has one, otherwise the usual one. Dialects must outlive the object.
class LinkDialects {
public:
    explicit LinkDialects(const dialect::Dialect& usual) : usual_(usual) {}

    // Gives an endpoint its own dialect, until `forget`. Call it before the endpoint is opened.
    void set(EndpointId endpoint, const dialect::Dialect& dialect) { own_.emplace(endpoint, LinkDialect{dialect}); }
    void forget(EndpointId endpoint) noexcept { own_.erase(endpoint); }
    [[nodiscard]] const LinkDialect& of(EndpointId endpoint) const noexcept {
        const auto own = own_.find(endpoint);
        return own == own_.end() ? usual_ : own->second;
    }

private:
    const LinkDialect usual_;
    std::map<EndpointId, LinkDialect> own_;
};

}  // namespace mavloom::link::detail
