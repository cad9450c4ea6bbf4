// SPDX-License-Identifier: MIT
// The requests of `mavloom ctl`: one JSON object per line. Modules router and simserve include this header.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <ranges>
#include <string>
#include <string_view>

#include "control/json_lines.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/control/served.hpp"

namespace mavloom::control {

// The lines that `append_lines` appends later, on another thread, and the line {"ok":true}.
[[nodiscard]] Report succeeded(std::function<void(std::string& text)> append_lines = [](std::string&) {});
// The line {"ok":false,"error":WHY}.
[[nodiscard]] Report failed(std::string_view why);
// The error of a request to remove `name`, which is no endpoint, recording or link.
[[nodiscard]] Report nothing_to_remove(std::string_view name);

// Empty if the request has no text under this key.
[[nodiscard]] std::string text_at(const Json& request, const char* key);

template <class Server>
struct Command {
    std::string_view name;  // under "cmd" in the request
    Report (*answer)(Server& server, const Json& request);
};

// Executes one request line. For an unknown command, the error has the names of the commands.
template <class Server, std::size_t count>
[[nodiscard]] Report answer_request(Server& server, std::string_view request,
                                    const std::array<Command<Server>, count>& commands) {
    const auto parsed = Json::parse(request, nullptr, false);
    if (!parsed.is_object())
        return failed(fmt::format(R"(a request is one JSON object per line, as in {{"cmd":"{}"}})", commands[0].name));
    const auto name = text_at(parsed, "cmd");
    const auto command = std::ranges::find(commands, name, &Command<Server>::name);
    if (command != commands.end()) return command->answer(server, parsed);
    const auto names = commands | std::views::transform(&Command<Server>::name);
    return failed(fmt::format("there is no command {}; there are {}", in_quotes(name), fmt::join(names, ", ")));
}

}  // namespace mavloom::control
