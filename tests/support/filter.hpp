// SPDX-License-Identifier: MIT
// A filter of the default dialect.
#pragma once

#include <stdexcept>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/dialect/filter.hpp"

namespace mavloom::test {

inline dialect::Filter make_filter(const dialect::FilterTerms& allow, const dialect::FilterTerms& block = {}) {
    dialect::Filter filter;
    if (auto done = filter.allow(dialect::default_dialect(), allow); !done)
        throw std::invalid_argument(done.error().text);
    if (auto done = filter.block(dialect::default_dialect(), block); !done)
        throw std::invalid_argument(done.error().text);
    return filter;
}

}  // namespace mavloom::test
