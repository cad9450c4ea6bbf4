// SPDX-License-Identifier: MIT
// LinkNames: the names of links, by the number that frames carry. Any thread.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <unordered_map>

#include "mavloom/base/ids.hpp"

namespace mavloom::feed {

class LinkNames {
public:
    // How many links that are gone keep their names.
    static constexpr std::size_t most_gone = 65'536;

    void add(LinkId link, std::string name);
    // The link is gone. It keeps its name for frames that still refer to it, until `most_gone` later links are gone.
    void gone(LinkId link);
    // Empty for a link that has no name.
    [[nodiscard]] std::string find(LinkId link) const;

private:
    mutable std::mutex mutex_;
    // Guarded by mutex_:
    std::unordered_map<LinkId, std::string> names_;
    std::deque<LinkId> gone_;  // links in names_ that are gone, the latest last
};

}  // namespace mavloom::feed
