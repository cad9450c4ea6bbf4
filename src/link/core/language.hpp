// SPDX-License-Identifier: MIT
// A Language holds what the links of an endpoint need from their dialect: the table for finding frames, and the rules
// for queueing them. Private to module link; single owner thread.
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

// The language of each endpoint: that of its own dialect if it has one, otherwise the usual language. Dialects must
// outlive the object.
class Languages {
public:
    explicit Languages(const dialect::Dialect& usual) : usual_(usual) {}

    // Gives an endpoint its own dialect, until `forget`. Call it before the endpoint is opened.
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
