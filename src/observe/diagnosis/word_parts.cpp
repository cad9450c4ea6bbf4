// SPDX-License-Identifier: MIT
#include "observe/diagnosis/word_parts.hpp"

#include <fmt/format.h>

#include "mavloom/base/source_text.hpp"

namespace mavloom::observe::words {

std::string percent(double ratio) {
    const double value = ratio * 100;
    return fmt::format("{:.{}f} %", value, value < 0.95 ? 2 : 1);
}

std::string hertz(double hz) { return fmt::format("{:.{}f} Hz", hz, hz < 9.95 ? 1 : 0); }

std::string message_name(const Evidence& evidence, MessageId id) {
    const auto* const message = evidence.dialect->find(id);
    return message == nullptr ? fmt::format("#{}", id.value) : std::string(message->name);
}

std::string shown_loss(double loss) {
    return fmt::format("QGroundControl, which has one sequence for each sender, will show a loss of about {}.",
                       percent(loss));
}

Finding of_source(std::string_view id, Finding::Severity severity, const Listened& source) {
    return {.id = id, .severity = severity, .where = source.name, .source = source.name};
}

Finding of_sender(std::string_view id, Finding::Severity severity, Source sender, const std::string& where) {
    return {
        .id = id, .severity = severity, .where = fmt::format("{} by {}", source_text(sender), where), .sender = sender};
}

Finding of_link(std::string_view id, Finding::Severity severity, const Evidence& evidence, LinkId link, Source sender) {
    auto finding = of_sender(id, severity, sender, std::string(evidence.name_of(link)));
    finding.link = evidence.name_of(link);
    if (const auto* const source = evidence.source_of(link)) finding.source = source->name;
    return finding;
}

}  // namespace mavloom::observe::words
