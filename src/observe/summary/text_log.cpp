// SPDX-License-Identifier: MIT
#include "observe/summary/text_log.hpp"

#include "mavloom/observe/summarizer.hpp"

namespace mavloom::observe {

bool TextLog::add(Source source, const OpenText& text) {
    if (text.text.empty()) return true;
    std::string key = text.text;
    for (const auto byte : {source.system.value, source.component.value, text.severity}) key += static_cast<char>(byte);
    const auto [known, is_new] = places_.try_emplace(std::move(key), texts_.size());
    if (is_new && texts_.size() == Summarizer::max_entries) {
        places_.erase(known);
        return false;
    }
    if (is_new) texts_.push_back({.source = source, .severity = text.severity, .text = text.text, .first = text.when});
    auto& summary = texts_[known->second];
    summary.last = text.when;
    ++summary.count;
    return true;
}

}  // namespace mavloom::observe
