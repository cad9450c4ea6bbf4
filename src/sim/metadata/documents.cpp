// SPDX-License-Identifier: MIT
#include "sim/metadata/documents.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "flight/firmware/firmware.hpp"
#include "sim/metadata/event_catalog.hpp"

namespace mavloom::sim {

namespace {

using Json = nlohmann::json;

std::string text(std::string_view view) { return std::string(view); }

// A whole number without a decimal point, for integer parameters. A float's value is not rounded to 32 bits: it then
// has the digits of the table, such as 0.15.
Json number(const ParamInfo& info, double value) {
    if (info.type == ParamType::real32) return value;
    return static_cast<std::int64_t>(value);
}

std::string type_name(ParamType type) {
    switch (type) {
        case ParamType::int8: return "Int8";
        case ParamType::int16: return "Int16";
        case ParamType::int32: return "Int32";
        case ParamType::real32: break;
    }
    return "Float";
}

Json choices(std::string_view key, std::span<const flight::ParamChoice> list) {
    Json entries = Json::array();
    for (const flight::ParamChoice& choice : list)
        entries.push_back({{std::string(key), choice.value}, {"description", choice.name}});
    return entries;
}

Json parameter(const ParamInfo& info) {
    Json entry{{"name", info.name},
               {"type", type_name(info.type)},
               {"default", number(info, info.initial)},
               {"category", "Standard"},
               {"group", info.group.empty() ? "Miscellaneous" : text(info.group)},
               {"shortDesc", info.summary.empty() ? text(info.name) : text(info.summary)}};
    if (std::isfinite(info.minimum)) entry["min"] = number(info, info.minimum);
    if (std::isfinite(info.maximum)) entry["max"] = number(info, info.maximum);
    if (!info.unit.empty()) entry["units"] = text(info.unit);
    if (info.type == ParamType::real32 && info.decimals != 0) entry["decimalPlaces"] = info.decimals;
    if (info.is_volatile) entry["volatile"] = true;
    if (info.needs_reboot) entry["rebootRequired"] = true;
    if (!info.choices.empty()) entry["values"] = choices("value", info.choices);
    if (!info.bit_names.empty()) entry["bitmask"] = choices("index", info.bit_names);
    return entry;
}

Json event(const EventInfo& info) {
    Json arguments = Json::array();
    for (const EventArgument& argument : info.arguments)
        arguments.push_back({{"name", argument.name}, {"type", argument.type}});
    Json entry{{"name", info.name}, {"message", info.message}};
    if (!info.description.empty()) entry["description"] = text(info.description);
    if (!info.type.empty()) entry["type"] = text(info.type);
    if (!arguments.empty()) entry["arguments"] = std::move(arguments);
    return entry;
}

Json event_groups() {
    Json groups = Json::object();
    for (const EventInfo& info : event_infos()) {
        Json& group = groups[text(info.group)];
        group["events"][std::to_string(event_sub_id(info))] = event(info);
    }
    return groups;
}

Json event_enum(const EventEnum& description) {
    Json entries = Json::object();
    for (const EventEnumEntry& entry : description.entries)
        entries[std::to_string(entry.value)] = {{"name", entry.name}, {"description", entry.description}};
    Json value{{"type", description.type}, {"entries", std::move(entries)}};
    if (description.is_bitfield) value["is_bitfield"] = true;
    return value;
}

// Which custom_mode each bit of a navigation mode group stands for.
Json navigation_mode_groups(const Firmware& firmware) {
    Json groups = Json::object();
    for (const NavigationGroup& group : navigation_groups())
        if (firmware.find_mode(group.custom_mode) != nullptr)
            groups[std::to_string(group.index)] = Json::array({group.custom_mode});
    return groups;
}

}  // namespace

std::string general_document(std::span<const ListedMetadata> files) {
    Json types = Json::array();
    for (const ListedMetadata& file : files)
        types.push_back(
            {{"type", static_cast<int>(file.type)}, {"uri", "mftp://" + text(file.path)}, {"fileCrc", file.file_crc}});
    return Json{{"version", 1}, {"metadataTypes", std::move(types)}}.dump();
}

std::string parameter_document(const Firmware& firmware) {
    Json parameters = Json::array();
    for (const ParamInfo& info : firmware.parameters()) parameters.push_back(parameter(info));
    return Json{{"version", 1}, {"parameters", std::move(parameters)}}.dump();
}

std::string event_document(const Firmware& firmware) {
    Json enums = Json::object();
    for (const EventEnum& description : event_enums()) enums[text(description.name)] = event_enum(description);
    Json autopilot{{"namespace", "px4"},
                   {"enums", std::move(enums)},
                   {"event_groups", event_groups()},
                   {"supported_protocols", Json::array({"health_and_arming_check"})},
                   {"navigation_mode_groups", {{"groups", navigation_mode_groups(firmware)}}}};
    return Json{{"version", 2}, {"components", {{"1", std::move(autopilot)}}}}.dump();
}

}  // namespace mavloom::sim
