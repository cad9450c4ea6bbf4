// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "mavloom/base/shown.hpp"
#include "output.hpp"
#include "parts.hpp"
#include "status_text.hpp"

namespace mavloom::app::shm_parts {

namespace {

Exit list(const Common& common, bool json) {
    std::string text;
    for (const auto& name : shm::ring_names()) {
        const auto ring = shm::ring_status(name);
        if (!ring && ring.error().code == SetupCode::not_found) continue;  // removed meanwhile
        if (json) text += line_of(ring ? json_of(*ring) : Json{{"name", name}, {"error", ring.error().text}});
        else text += ring ? text_of(*ring) : fmt::format("{}  {}\n", name, printable(ring.error().text));
    }
    if (text.empty()) print_notice(common, "there are no rings");
    return print_at_end(text, Exit::done);
}

}  // namespace

Run declare_list(Arguments part, const Common& common) {
    auto json = std::make_shared<bool>(false);
    add_json(part, *json);
    return [json, &common] { return list(common, *json); };
}

}  // namespace mavloom::app::shm_parts
