// SPDX-License-Identifier: MIT
#include "mavloom/feed/link_names.hpp"

#include <utility>

namespace mavloom::feed {

void LinkNames::add(LinkId link, std::string name) {
    const std::lock_guard lock(mutex_);
    if (!names_.insert_or_assign(link, std::move(name)).second) std::erase(gone_, link);  // the link is back
}

void LinkNames::gone(LinkId link) {
    const std::lock_guard lock(mutex_);
    gone_.push_back(link);
    if (gone_.size() <= max_gone) return;
    names_.erase(gone_.front());
    gone_.pop_front();
}

std::string LinkNames::find(LinkId link) const {
    const std::lock_guard lock(mutex_);
    const auto known = names_.find(link);
    return known == names_.end() ? std::string() : known->second;
}

}  // namespace mavloom::feed
