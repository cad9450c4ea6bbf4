// SPDX-License-Identifier: MIT
// Which frames the links of an endpoint find, and how these frames queue. Private to module link; single owner thread.
#pragma once

#include <map>

#include "link/core/message_class.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::link::detail {

struct Language {
    explicit Language(const dialect::Dialect& dialect) : table(dialect.wire_table()), classes(dialect) {}

    const wire::MessageTable& table;
    MessageClasses classes;
};

// The language of each endpoint: its own dialect's, or else the usual one. Dialects must outlive the object.
class Languages {
public:
    explicit Languages(const dialect::Dialect& usual) : usual_(usual) {}

    // Gives an endpoint its own dialect. Call it before the endpoint is opened; `forget` ends it.
    void set(EndpointId endpoint, const dialect::Dialect& dialect) { own_.emplace(endpoint, Language{dialect}); }
    void forget(EndpointId endpoint) noexcept { own_.erase(endpoint); }
    [[nodiscard]] const Language& of(EndpointId endpoint) const noexcept {
        const auto own = own_.find(endpoint);
        return own == own_.end() ? usual_ : own->second;
    }

private:
    const Language usual_;
    std::map<EndpointId, Language> own_;
};

}  // namespace mavloom::link::detail
