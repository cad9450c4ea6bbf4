// SPDX-License-Identifier: MIT
// `mavloom stat NAME`: the counters of a running program, as text for people.
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "ctl/answers.hpp"
#include "mavloom/control/control.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/shm/counter_page.hpp"
#include "mavloom/shm/ring_info.hpp"
#include "output.hpp"
#include "page/page_hop.hpp"

namespace mavloom::app {

namespace {

struct StatOptions {
    std::string name = "router";
    bool json = false;
};

// Converts the counters of a page (docs/formats/ring.md) to JSON objects like those of a router's answer: one for the
// page, one for each link, one for all other links.
Lines lines_of(std::string_view name, const shm::CounterSnapshot& snapshot) {
    constexpr std::string_view others_prefix = "others_";
    Json page{{"kind", "page"},
              {"name", name},
              {"alive", snapshot.owner_alive},
              {"pid", snapshot.owner_pid},
              {"started_us", unix_us(snapshot.started)}};
    Json others{{"kind", "others"}};
    std::map<LinkId, Json> links;
    for (const auto& counter : snapshot.counters) {
        if (counter.link && counter.label == "up") links[*counter.link]["up"] = counter.value != 0;
        else if (counter.link) links[*counter.link][counter.label] = counter.value;
        else if (counter.label.starts_with(others_prefix))
            others[counter.label.substr(others_prefix.size())] = counter.value;
        else page[counter.label] = counter.value;
    }
    const auto text_of = [](const Json& o) { return o.dump(-1, ' ', false, Json::error_handler_t::replace); };
    Lines lines{text_of(page)};
    for (const auto& [id, counts] : links) {
        const auto known = snapshot.links.find(id);
        Json link{{"kind", "link"}, {"id", id.value}, {"link", known == snapshot.links.end() ? "" : known->second}};
        link.update(counts);
        lines.push_back(text_of(link));
    }
    if (others.size() > 1) lines.push_back(text_of(others));
    return lines;
}

// A router without a ring knows more than its page: what each sender sent.
bool has_all(const shm::CounterSnapshot& page, std::string_view name) {
    const auto rings = shm::ring_names();
    return is_of_simulator(page) || std::ranges::find(rings, name) != rings.end();
}

// Prefers the counter page of a live process, because reading it does not disturb the router. A page that a killed
// process left behind is used only if no router answers.
SetupResult<Lines> stats_of(const std::string& name) {
    const auto page = shm::read_counters(name, {.user = link::Links::owner_of_inlets()});
    if (page && page->owner_alive && has_all(*page, name)) return lines_of(name, *page);
    auto asked = ask(name, {{"cmd", "stats"}});
    if (asked || (!page && page.error().code == SetupCode::not_found)) return asked;
    if (!page) return tl::unexpected(page.error());
    return lines_of(name, *page);
}

Exit stat(const StatOptions& options) {
    const auto lines = stats_of(options.name);
    if (!lines) return fail(lines.error());
    return options.json ? print_lines(*lines) : print_at_end(paragraphs_of(*lines), Exit::done);
}

}  // namespace

Run declare_stat(Arguments command, const Common&) {
    auto options = std::make_shared<StatOptions>();
    command.add_option("name", "NAME", options->name, "the --ring of a router or simulator, or its --name")
        .capture_default_str();
    command.add_flag("--json", options->json, "print one JSON object per line");
    command.footer(
        "Reads the counter page of a router's --ring or of a simulator, without involving its process. If a\n"
        "router has no ring, asks the router itself, like `ctl NAME stats`.\n\n"
        "Examples: mavloom stat router\n"
        "          mavloom stat px4 --json\n"
        "          mavloom stat sim");
    return [options] { return stat(*options); };
}

}  // namespace mavloom::app
