// SPDX-License-Identifier: MIT
#include "control/json_request.hpp"

#include <utility>

namespace mavloom::control {

Report succeeded(std::function<void(std::string& text)> append_lines) {
    return report_of([append_lines = std::move(append_lines)] {
        std::string text;
        append_lines(text);
        append_ok(text);
        return text;
    });
}

Report failed(std::string_view why) {
    std::string text;
    append_line(text, {{"ok", false}, {"error", why}});
    return report_of([text = std::move(text)] { return text; });
}

Report nothing_to_remove(std::string_view name) {
    return failed(fmt::format(
        "there is no endpoint {}, and no link of that name that could be closed; `links` lists them", name));
}

std::string text_at(const Json& request, const char* key) {
    const auto at = request.find(key);
    return at != request.end() && at->is_string() ? at->get<std::string>() : std::string();
}

}  // namespace mavloom::control
