// SPDX-License-Identifier: MIT
#include "mavloom/feed/instance.hpp"

#include "mavloom/message/view.hpp"

namespace mavloom::feed {

const dialect::Field* instance_field(const dialect::Message& message) noexcept {
    for (const auto& field : message.fields)
        if (field.instance) return &field;
    return nullptr;
}

Instance instance_of(const dialect::Message& message, const dialect::Field& field, const wire::FrameView& frame) {
    const message::MessageView view(message, frame.payload());
    if (field.type == dialect::FieldType::char8) return std::string(view.text(field));
    return view.integer(field);
}

}  // namespace mavloom::feed
