// SPDX-License-Identifier: MIT
#include "edit/plan.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>

#include "mavloom/message/builder.hpp"

namespace mavloom::edit {

namespace {

constexpr std::uint32_t max_message_id = 0xffffff;  // 24 bits on the wire

tl::unexpected<SetupError> usage(std::string text) { return setup_error(SetupCode::usage, std::move(text)); }

// The whole of `text` as a number; empty where it is none.
template <class T>
std::optional<T> number(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// Calls `each` for every term of every list; terms may also stand in one text, separated by commas.
template <class F>
SetupResult<void> for_each_term(const std::vector<std::string>& lists, std::string_view option, F&& each) {
    for (std::string_view list : lists) {
        while (true) {
            const auto comma = list.find(',');
            if (auto done = each(list.substr(0, comma)); !done)
                return tl::unexpected(std::move(done.error()).within(option));
            if (comma == std::string_view::npos) break;
            list.remove_prefix(comma + 1);
        }
    }
    return {};
}

SetupResult<std::uint32_t> message_id(const dialect::Dialect& dialect, std::string_view name_or_id) {
    const bool digits = !name_or_id.empty() && name_or_id.find_first_not_of("0123456789") == std::string_view::npos;
    if (!digits) {
        const auto message = dialect.message(name_or_id);
        if (!message) return tl::unexpected(message.error());
        return (*message)->id().value;
    }
    const auto id = number<std::uint32_t>(name_or_id);
    if (!id || *id > max_message_id)
        return usage(fmt::format("'{}' is no message id (0 to {})", name_or_id, max_message_id));
    return *id;
}

SetupResult<void> add_rate(const dialect::Dialect& dialect, std::string_view term,
                           std::vector<RateLimiter::Rate>& rates, std::optional<Nanoseconds>& others) {
    const auto colon = term.rfind(':');
    if (colon == std::string_view::npos)
        return usage(fmt::format("'{}' has no rate; type for example ATTITUDE:10 or *:50", term));
    const auto name = term.substr(0, colon);
    const auto rate_hz = number<double>(term.substr(colon + 1));
    if (!rate_hz || !std::isfinite(*rate_hz) || *rate_hz <= 0)
        return usage(fmt::format("'{}': the rate is a number above 0, in Hz", term));
    constexpr double ten_years_ns = 3653 * 86400e9;
    const Nanoseconds interval{std::llround(std::min(1e9 / *rate_hz, ten_years_ns))};
    if (name == "*") {
        if (others) return usage("'*' has two rates");
        others = interval;
        return {};
    }
    const auto id = message_id(dialect, name);
    if (!id) return tl::unexpected(id.error());
    const auto same = [&](const RateLimiter::Rate& rate) { return rate.id == *id; };
    if (std::any_of(rates.begin(), rates.end(), same)) return usage(fmt::format("'{}' has two rates", name));
    rates.push_back({*id, interval});
    return {};
}

SetupResult<Patch> make_patch(const dialect::Dialect& dialect, std::string_view text) {
    const auto equals = text.find('=');
    if (equals == std::string_view::npos)
        return usage(fmt::format("'{}' has no value; type for example ATTITUDE.roll=0.1", text));
    const auto handle = dialect.field(text.substr(0, equals));
    if (!handle) return tl::unexpected(handle.error());
    const auto& field = *handle->field;
    message::MessageBuilder builder(*handle->message);
    if (auto done = builder.set_from_text(field, text.substr(equals + 1)); !done)
        return tl::unexpected(std::move(done.error()));
    Patch patch{handle->message->id().value, field.offset, static_cast<std::uint8_t>(field.size())};
    const auto bytes = builder.payload().subspan(field.offset, field.size());
    std::copy(bytes.begin(), bytes.end(), patch.bytes.begin());
    return patch;
}

SetupResult<std::uint8_t> system_id(std::string_view text) {
    const auto id = number<unsigned>(text);
    if (!id || *id == 0 || *id > 255) return usage(fmt::format("'{}' is no system id (1 to 255)", text));
    return static_cast<std::uint8_t>(*id);
}

SetupResult<void> add_remap(std::string_view text, Plan& plan) {
    const auto equals = text.find('=');
    if (equals == std::string_view::npos) return usage(fmt::format("'{}' has no '='; type for example 1=42", text));
    const auto from = system_id(text.substr(0, equals));
    if (!from) return tl::unexpected(from.error());
    const auto to = system_id(text.substr(equals + 1));
    if (!to) return tl::unexpected(to.error());
    if (plan.forward[*from] != *from)
        return usage(fmt::format("system {} cannot become both {} and {}", *from, plan.forward[*from], *to));
    if (plan.backward[*to] != *to)
        return usage(fmt::format("systems {} and {} cannot both become {}: answers would not find their way back",
                                 plan.backward[*to], *from, *to));
    plan.forward[*from] = *to;
    plan.backward[*to] = *from;
    plan.remaps = plan.remaps || *from != *to;
    return {};
}

}  // namespace

SystemMap identity_map() noexcept {
    SystemMap map;
    std::iota(map.begin(), map.end(), std::uint8_t{0});
    return map;
}

SetupResult<Plan> make_plan(const dialect::Dialect& dialect, const Options& options) {
    Plan plan;
    auto done = for_each_term(options.only, "--only", [&](std::string_view name) -> SetupResult<void> {
        const auto id = message_id(dialect, name);
        if (!id) return tl::unexpected(id.error());
        plan.only.push_back(*id);
        return {};
    });
    if (!done) return tl::unexpected(std::move(done.error()));
    std::sort(plan.only.begin(), plan.only.end());

    std::vector<RateLimiter::Rate> rates;
    std::optional<Nanoseconds> others;
    done = for_each_term(options.max_rate, "--max-rate",
                         [&](std::string_view term) { return add_rate(dialect, term, rates, others); });
    if (!done) return tl::unexpected(std::move(done.error()));
    plan.limiter = RateLimiter(std::move(rates), others);

    done = for_each_term(options.remap_system, "--remap-system",
                         [&](std::string_view term) { return add_remap(term, plan); });
    if (!done) return tl::unexpected(std::move(done.error()));

    for (const auto& text : options.set) {  // not split: a comma can be part of a value
        auto patch = make_patch(dialect, text);
        if (!patch) return tl::unexpected(std::move(patch.error()).within("--set"));
        plan.patches.push_back(*patch);
    }
    std::stable_sort(plan.patches.begin(), plan.patches.end(),
                     [](const Patch& a, const Patch& b) { return a.id < b.id; });
    return plan;
}

}  // namespace mavloom::edit
