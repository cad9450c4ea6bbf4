// SPDX-License-Identifier: MIT
#include "explain.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mavloom/base/counted.hpp"
#include "mavloom/dialect/terms.hpp"

namespace mavloom::app {

static constexpr std::chrono::milliseconds output_retry{100};

void ExplainPrinter::operator()(const link::RxFrame& rx, const route::Decision& decision,
                                std::span<const route::Explanation> why) {
    if (only_ && rx.frame.id() != *only_) return;
    if (output_.full()) (void)output_.flush_what_fits();
    if (output_.full()) return leave_out(1 + why.size());
    auto out = fmt::appender(output_.buffer());
    const auto* message = dialect_.find(rx.frame.id());
    const auto source = rx.frame.source();
    fmt::format_to(out, "{} {}/{} seq {} from {}: {}\n",
                   message != nullptr ? std::string(message->name) : fmt::format("id {}", rx.frame.id().value),
                   source.system.value, source.component.value, rx.frame.sequence(), links_.link_name(rx.link),
                   route::verdict_name(decision.verdict));
    for (const auto& [link, reason] : why)
        fmt::format_to(out, "  {} {}: {}\n", reason == route::Reason::sent || reason == route::Reason::tap ? "->" : " x",
                       links_.link_name(link), route::reason_text(reason));
}

MonoTime ExplainPrinter::due() { return output_.buffer().size() == 0 ? MonoTime::max() : mono_now() + output_retry; }

void ExplainPrinter::finish() {
    output_.end_at(mono_now());
    while (flush() == Output::State::open && output_.buffer().size() != 0 && output_.wait_for_room()) {}
    left_out_ += static_cast<std::uint64_t>(std::ranges::count(output_.buffer(), '\n'));
    report_left_out();
}

void ExplainPrinter::report_left_out() const {
    if (left_out_ != 0) print_notice(common_, fmt::format("--explain left out {}", counted(left_out_, "line")));
}

void ExplainPrinter::leave_out(std::size_t lines) {
    if (left_out_ == 0 && output_.state() == Output::State::open)
        print_notice(common_,
                     "the output of --explain is read too slowly; explanations are left out, and routing continues");
    left_out_ += lines;
}

SetupResult<std::optional<MessageId>> explained_id(const dialect::Dialect& dialect, const std::string& text) {
    if (text == "*") return std::nullopt;
    const auto id = dialect::find_message_id(dialect, text);
    if (!id) return tl::unexpected(SetupError(id.error()).within("--explain"));
    return *id;
}

}  // namespace mavloom::app
