// SPDX-License-Identifier: MIT
#include "mavloom/message/instance.hpp"

#include "mavloom/message/view.hpp"

namespace mavloom::message {

const dialect::Field* instance_field(const dialect::Message& message) noexcept {
    for (const auto& field : message.fields)
        if (field.instance) return &field;
    return nullptr;
}

Instance instance_of(const dialect::Message& message, const dialect::Field& field, ByteView payload) {
    const MessageView view(message, payload);
    if (field.type == dialect::FieldType::char8) return std::string(view.text(field));
    return view.integer(field);
}

std::string text_of(const Instance& instance) {
    const auto* const number = std::get_if<std::int64_t>(&instance);
    return number != nullptr ? std::to_string(*number) : std::get<std::string>(instance);
}

}  // namespace mavloom::message
