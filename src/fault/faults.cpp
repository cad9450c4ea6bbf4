// SPDX-License-Identifier: MIT
#include "mavloom/fault/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "fault/stages.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::fault {

using namespace detail;
using link::LinkCounters;

namespace {

using Chain = std::vector<std::unique_ptr<link::Stage>>;

// Adds the stages of one direction, in the order of docs/guide/faults.md. Each gets its own random stream.
class ChainMaker {
public:
    ChainMaker(Seed seed, const link::StageSite& site, std::string_view way)
        : seed_(seed.with(way)), counters_(site.counters), log_(log_site(site.name, way)) {}

    [[nodiscard]] Chain make(const endpoint::Faults& f) && {
        if (f.blackout.length.count() != 0) add<BlackOut>(f.blackout, tally("blackout", counters_.fault_blackout));
        if (f.loss > 0 && f.burst > 0)
            add<LoseInBursts>(f.loss, f.burst, stream("loss"), tally("loss", counters_.fault_lost));
        else if (f.loss > 0) add<Lose>(f.loss, stream("loss"), tally("loss", counters_.fault_lost));
        add_share<Duplicate>("duplicate", f.duplicate, counters_.fault_duplicated);
        add_share<Corrupt>("corrupt", f.corrupt, counters_.fault_corrupted);
        add_share<CutShort>("cut", f.cut, counters_.fault_cut);
        if (f.delay.count() != 0)
            add<Delay>(f.delay, f.jitter, stream("delay"), tally("delay", counters_.fault_delayed));
        if (f.stall.length.count() != 0) add<Stall>(f.stall, tally("stall", counters_.fault_stalled));
        if (f.reorder > 0)
            add<Reorder>(f.reorder, f.reorder_by, stream("reorder"), tally("reorder", counters_.fault_reordered));
        if (f.rate_bytes_s != 0) add<Narrow>(f.rate_bytes_s, f.rate_queue_bytes, tally("rate", counters_.fault_queue));
        return std::move(chain_);
    }

private:
    template <class Stage, class... Args>
    void add(Args&&... args) {
        chain_.push_back(std::make_unique<Stage>(std::forward<Args>(args)...));
    }
    template <class Stage>
    void add_share(std::string_view name, double share, Counter& counter) {
        if (share > 0) add<Stage>(share, stream(name), tally(name, counter));
    }
    [[nodiscard]] Seed stream(std::string_view name) const { return seed_.with(name); }
    [[nodiscard]] Tally tally(std::string_view name, Counter& counter) const { return {counter, name, log_}; }

    Seed seed_;
    LinkCounters& counters_;
    std::shared_ptr<const LogSite> log_;
    Chain chain_;
};

// Creates the stages of a plan. Links keeps it, so that a change finds the plan again.
struct Maker {
    Plan plan;
    std::string label;
    [[nodiscard]] link::Stages operator()(const link::StageSite& site) const { return stages_of(plan, label, site); }
};

std::string shown_text(const endpoint::Faults& faults) { return faults.any() ? faults.text : "off"; }

SetupResult<endpoint::Faults> parse(std::string_view text, const endpoint::Endpoint& endpoint) {
    auto faults = endpoint::parse_faults(text);
    if (!faults) return faults;
    if (auto good = endpoint::check_faults(*faults, endpoint.row()); !good) return tl::unexpected(good.error());
    return faults;
}

SetupResult<void> apply(const Change& change, const endpoint::Endpoint& endpoint, Plan& plan) {
    if (!change.in && !change.out)
        return endpoint::usage("faults for 'in', 'out' or both are missing; 'off' ends them");
    if (change.seed)
        if (auto done = endpoint::put(endpoint::parse_fault_seed(*change.seed), plan.seed); !done)
            return tl::unexpected(std::move(done.error()).within("seed"));
    if (change.in)
        if (auto done = endpoint::put(parse(*change.in, endpoint), plan.in); !done) return done;
    return change.out ? endpoint::put(parse(*change.out, endpoint), plan.out) : SetupResult<void>{};
}

// An endpoint, or one of its links.
struct FaultTarget {
    link::EndpointInfo endpoint;
    std::optional<LinkId> link;
};

std::optional<FaultTarget> find(const link::Links& links, std::string_view name) {
    const auto endpoints = links.endpoints();
    for (const auto& endpoint : endpoints)
        if (endpoint.label() == name || endpoint.endpoint.label() == name) return FaultTarget{endpoint, {}};
    const auto all = links.links();
    const auto link = std::ranges::find(all, name, &link::LinkInfo::name);
    if (link == all.end()) return std::nullopt;
    const auto endpoint = std::ranges::find(endpoints, link->endpoint, &link::EndpointInfo::id);
    if (endpoint == endpoints.end()) return std::nullopt;
    return FaultTarget{*endpoint, link->id};
}

// Without faults, the seed is that of the endpoint's options.
Plan plan_at(const link::Links& links, const FaultTarget& target) {
    const auto* const by = target.link ? links.stages_by(*target.link) : links.stages_by(target.endpoint.id);
    const Maker* const maker = by == nullptr ? nullptr : by->target<Maker>();
    if (maker != nullptr && maker->plan.any()) return maker->plan;
    return {.in = {}, .out = {}, .seed = target.endpoint.endpoint.options.fault_seed.value_or(1)};
}

bool put_stages(link::Links& links, const FaultTarget& target, const Plan& plan) {
    const Maker maker{plan, target.endpoint.endpoint.label()};
    if (target.link) return links.set_stages(*target.link, maker);
    return links.set_stages(target.endpoint.id, plan.any() ? link::CreateStages(maker) : nullptr);
}

}  // namespace

std::string Plan::text() const {
    if (!any()) return "off";
    const std::string seed_text = fmt::format(", seed {}", seed);
    if (in == out) return fmt::format("in and out {}{}", in.text, seed_text);
    return fmt::format("in {}, out {}{}", shown_text(in), shown_text(out), seed_text);
}

Plan plan_of(const endpoint::EndpointOptions& options) {
    return {endpoint::inward_faults(options), endpoint::outward_faults(options), options.fault_seed.value_or(1)};
}

link::Stages stages_of(const Plan& plan, std::string_view label, const link::StageSite& site) {
    if (!plan.any()) return {};
    const Seed seed = Seed(plan.seed).with(label).with(site.ordinal);
    link::Stages stages;
    stages.in = ChainMaker(seed, site, "in").make(plan.in);
    stages.out = ChainMaker(seed, site, "out").make(plan.out);
    if (site.is_stream && !stages.in.empty())
        stages.in.insert(stages.in.begin(), std::make_unique<CutIntoFrames>(site.table));
    stages.text = plan.text();
    return stages;
}

SetupResult<link::EndpointId> add(link::Links& links, const endpoint::Endpoint& endpoint,
                                  const dialect::Dialect* dialect) {
    auto id = links.add(endpoint, dialect);
    const Plan plan = plan_of(endpoint.options);
    if (!id || !plan.any()) return id;
    links.set_stages(*id, Maker{plan, endpoint.label()});
    links.report(*id, fmt::format("{}: faults on purpose: {}", endpoint.label(), plan.text()));
    return id;
}

SetupResult<std::string> change(link::Links& links, std::string_view name, const Change& change) {
    const auto place = find(links, name);
    if (!place)
        return setup_error(SetupCode::usage, fmt::format("there is no endpoint or link {}", endpoint::in_quotes(name)));
    Plan plan = plan_at(links, *place);
    if (auto done = apply(change, place->endpoint.endpoint, plan); !done)
        return tl::unexpected(std::move(done.error()));
    if (!put_stages(links, *place, plan))
        return setup_error(SetupCode::usage, fmt::format("{} is a ring, which has no faults", name));
    return plan.text();
}

}  // namespace mavloom::fault
