// SPDX-License-Identifier: MIT
#include "message/command_params.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mavloom::message {
namespace {

using dialect::Field;
using dialect::FieldType;

bool carries_params(std::string_view message) noexcept {
    constexpr std::array names{std::string_view{"COMMAND_LONG"}, std::string_view{"COMMAND_INT"},
                               std::string_view{"MISSION_ITEM"}, std::string_view{"MISSION_ITEM_INT"}};
    return std::find(names.begin(), names.end(), message) != names.end();
}

// Returns 1 to 7, or 0 if the field is not a parameter.
unsigned param_index(const Field& field) noexcept {
    constexpr std::string_view prefix = "param";
    if (field.is_array()) return 0;
    if (field.name.size() == prefix.size() + 1 && field.name.starts_with(prefix))
        return static_cast<unsigned>(field.name.back() - '0');
    if (field.name == "x") return 5;
    if (field.name == "y") return 6;
    return field.name == "z" ? 7 : 0;
}

// MAV_FRAME_GLOBAL, _RELATIVE_ALT, _INT, _RELATIVE_ALT_INT, _TERRAIN_ALT, _TERRAIN_ALT_INT.
bool is_global_frame(std::uint64_t frame) noexcept {
    constexpr std::array<std::uint64_t, 6> global{0, 3, 5, 6, 10, 11};
    return std::find(global.begin(), global.end(), frame) != global.end();
}

}  // namespace

CommandParams::CommandParams(const MessageView& view, const dialect::Dialect& dialect) noexcept : dialect_(&dialect) {
    const auto& message = view.definition();
    if (!carries_params(message.name)) return;
    const auto* command = message.find("command");
    if (command == nullptr || command->enumeration == nullptr || command->is_array()) return;
    command_ = command->enumeration->find(view.unsigned_integer(*command));
    const auto* frame = message.find("frame");
    global_frame_ = frame != nullptr && !frame->is_array() && is_global_frame(view.unsigned_integer(*frame));
}

std::optional<CommandParams::Param> CommandParams::find(const Field& field) const noexcept {
    if (command_ == nullptr) return std::nullopt;
    const auto index = param_index(field);
    if (index == 0) return std::nullopt;
    const auto& params = command_->params;
    const auto found = std::find_if(params.begin(), params.end(), [&](const auto& p) { return p.index == index; });
    if (found == params.end()) return std::nullopt;
    const auto* enumeration = found->enum_name.empty() ? nullptr : dialect_->find_enum(found->enum_name);
    const bool position = (index == 5 && found->label.starts_with("Lat")) ||
                          (index == 6 && found->label.starts_with("Lon"));
    return Param{&field, &*found, enumeration, position && global_frame_ && field.type == FieldType::i32};
}

bool CommandParams::Param::is_unset(const MessageView& view) const noexcept {
    const auto value = view.number(*field);
    return std::isnan(value) || (degrees_e7 && value == std::numeric_limits<std::int32_t>::max());
}

}  // namespace mavloom::message
