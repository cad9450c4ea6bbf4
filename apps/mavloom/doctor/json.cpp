// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "doctor/reports.hpp"

namespace mavloom::app {

namespace {

using Json = nlohmann::ordered_json;

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json name_or_null(const dialect::Message* message) { return message == nullptr ? Json(nullptr) : Json(message->name); }

Json finding_json(const observe::Evidence& evidence, const observe::Finding& finding) {
    const auto* const message = finding.message ? evidence.dialect->find(*finding.message) : nullptr;
    Json object{{"id", finding.id},
                {"severity", observe::name_of(finding.severity)},
                {"where", finding.where},
                {"what", finding.what},
                {"why", finding.why},
                {"do", finding.remedy},
                {"source", text_or_null(finding.source)},
                {"link", text_or_null(finding.link)}};
    object["sys"] = finding.sender ? Json(finding.sender->system.value) : Json(nullptr);
    object["comp"] = finding.sender ? Json(finding.sender->component.value) : Json(nullptr);
    object["message"] = name_or_null(message);
    return object;
}

Json sender_json(const observe::SenderStream& sender) {
    return {{"sys", sender.source.system.value},
            {"comp", sender.source.component.value},
            {"frames", sender.frames},
            {"station_loss_percent", 100 * sender.station_loss()}};
}

Json source_json(const observe::Evidence& evidence, std::size_t i) {
    const auto& source = evidence.sources[i];
    Json counts = Json::object();
    for (const auto& count : source.counts) counts[count.name] = source.count(count.name);
    auto senders = Json::array();
    for (const auto& sender : evidence.senders[i]) senders.push_back(sender_json(sender));
    return {{"name", source.name},
            {"frames", source.count("frames_in")},
            {"counts", std::move(counts)},
            {"senders", std::move(senders)}};
}

Json passage_json(const observe::Evidence& evidence, std::size_t first, const observe::Passage& passage) {
    auto messages = Json::array();
    for (const auto& message : passage.messages) {
        messages.push_back({{"id", message.id.value},
                            {"name", name_or_null(evidence.dialect->find(message.id))},
                            {"heard", message.heard},
                            {"lost", message.lost}});
    }
    return {{"a", evidence.sources[first].name},
            {"b", evidence.sources[first + 1].name},
            {"sys", passage.source.system.value},
            {"comp", passage.source.component.value},
            {"comparable", passage.is_comparable},
            {"rewritten", passage.is_rewritten},
            {"frames", passage.before},
            {"lost", passage.lost},
            {"filtered", passage.filtered},
            {"targeted", passage.targeted},
            {"added", passage.added},
            {"messages", std::move(messages)}};
}

}  // namespace

std::string doctor_json(const observe::Evidence& evidence, std::span<const observe::Finding> findings) {
    auto all = Json::array(), sources = Json::array(), passages = Json::array();
    for (const auto& finding : findings) all.push_back(finding_json(evidence, finding));
    for (std::size_t i = 0; i < evidence.sources.size(); ++i) sources.push_back(source_json(evidence, i));
    for (std::size_t i = 0; i < evidence.passages.size(); ++i)
        for (const auto& passage : evidence.passages[i]) passages.push_back(passage_json(evidence, i, passage));
    const Json object{{"duration_s", evidence.seconds()},
                      {"findings", std::move(all)},
                      {"sources", std::move(sources)},
                      {"compared", std::move(passages)}};
    return object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mavloom::app
