// SPDX-License-Identifier: MIT
#include "edit/plan.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>

#include "mavloom/dialect/terms.hpp"
#include "mavloom/message/builder.hpp"

namespace mavloom::edit {

namespace {

tl::unexpected<SetupError> usage(std::string text) { return setup_error(SetupCode::usage, std::move(text)); }

// Parses all of `text` as a number; empty if it is not one.
template <class T>
std::optional<T> number(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// Calls `each` for every term of every list. One string may hold several terms, separated by commas.
template <class F>
SetupResult<void> for_all_terms(const std::vector<std::string>& lists, std::string_view option, F&& each) {
    for (const std::string& list : lists)
        if (auto done = dialect::for_each_term(list, each); !done)
            return tl::unexpected(std::move(done.error()).within(option));
    return {};
}

// A field name, and the text between the brackets of an optional "[3]" at its end.
struct ElementName {
    std::string_view field;
    std::optional<std::string_view> index;
};

ElementName split_element(std::string_view name) {
    const auto bracket = name.find('[');
    if (bracket == std::string_view::npos || !name.ends_with(']')) return {name, std::nullopt};
    return {name.substr(0, bracket), name.substr(bracket + 1, name.size() - bracket - 2)};
}

SetupResult<std::size_t> element_index(const dialect::Field& field, std::string_view name, std::string_view text) {
    if (!field.is_array() || field.is_text())
        return usage(fmt::format("{}: {} is not an array of numbers", name, field.name));
    const auto index = number<std::size_t>(text);
    if (!index || *index >= field.count())
        return usage(fmt::format("{}: elements are [0] to [{}]", name, field.count() - 1));
    return *index;
}

SetupResult<Patch> make_patch(const dialect::Dialect& dialect, std::string_view text) {
    const auto equals = text.find('=');
    if (equals == std::string_view::npos)
        return usage(fmt::format("'{}' has no value; for example, type ATTITUDE.roll=0.1", text));
    const auto name = text.substr(0, equals), value = text.substr(equals + 1);
    const auto element = split_element(name);
    const auto handle = dialect.field(element.field);
    if (!handle) return tl::unexpected(handle.error());
    const auto& field = *handle->field;
    message::MessageBuilder builder(*handle->message);
    std::size_t offset = field.offset, size = field.size();
    if (element.index) {
        const auto index = element_index(field, name, *element.index);
        if (!index) return tl::unexpected(index.error());
        if (auto done = builder.set_element_from_text(field, value, *index); !done)
            return tl::unexpected(std::move(done.error()));
        size /= field.count();
        offset += *index * size;
    } else if (auto done = builder.set_from_text(field, value); !done) {
        return tl::unexpected(std::move(done.error()));
    }
    Patch patch{handle->message->id().value, static_cast<std::uint8_t>(offset), static_cast<std::uint8_t>(size)};
    const auto bytes = builder.payload().subspan(offset, size);
    std::copy(bytes.begin(), bytes.end(), patch.bytes.begin());
    return patch;
}

SetupResult<void> add_rates(const dialect::Dialect& dialect, const std::vector<std::string>& lists, Plan& plan) {
    std::vector<dialect::RateTerm> terms;
    auto done = for_all_terms(lists, "--max-rate", [&](std::string_view text) -> SetupResult<void> {
        auto term = dialect::parse_rate_term(text);
        if (term) terms.push_back(std::move(*term));
        return term ? SetupResult<void>{} : tl::unexpected(std::move(term.error()));
    });
    if (!done) return done;
    auto rates = dialect::Rates::compile(dialect, terms);
    if (!rates) return tl::unexpected(std::move(rates.error()).within("--max-rate"));
    plan.limiter = dialect::RateLimiter<WallTime>(std::move(*rates));
    for (const auto& warning : rate_warnings(dialect, terms))
        plan.warnings.push_back(fmt::format("--max-rate {}", warning));
    return {};
}

SetupResult<std::uint8_t> system_id(std::string_view text) {
    const auto id = number<unsigned>(text);
    if (!id || *id == 0 || *id > 255) return usage(fmt::format("'{}' is not a system id (1 to 255)", text));
    return static_cast<std::uint8_t>(*id);
}

SetupResult<void> add_remap(std::string_view text, Plan& plan) {
    const auto equals = text.find('=');
    if (equals == std::string_view::npos) return usage(fmt::format("'{}' has no '='; for example, type 1=42", text));
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
    auto done = add_rates(dialect, options.max_rate, plan);
    if (!done) return tl::unexpected(std::move(done.error()));

    done = for_all_terms(options.remap_system, "--remap-system",
                         [&](std::string_view term) { return add_remap(term, plan); });
    if (!done) return tl::unexpected(std::move(done.error()));

    for (const auto& text : options.set) {  // not split at commas: a value may contain one
        auto patch = make_patch(dialect, text);
        if (!patch) return tl::unexpected(std::move(patch.error()).within("--set"));
        plan.patches.push_back(*patch);
    }
    std::stable_sort(plan.patches.begin(), plan.patches.end(),
                     [](const Patch& a, const Patch& b) { return a.id < b.id; });
    return plan;
}

}  // namespace mavloom::edit
