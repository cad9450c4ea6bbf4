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
    // How many closed links keep their names.
    static constexpr std::size_t max_gone = 65'536;

    void add(LinkId link, std::string name);
    // Notes that the link is closed. Its name stays for frames that still refer to it, until `max_gone` more links
    // have closed.
    void gone(LinkId link);
    // Empty for a link that has no name.
    [[nodiscard]] std::string find(LinkId link) const;

private:
    mutable std::mutex mutex_;
    // Guarded by mutex_:
    std::unordered_map<LinkId, std::string> names_;
    std::deque<LinkId> gone_;  // closed links that are still in names_, the latest last
};

}  // namespace mavloom::feed
