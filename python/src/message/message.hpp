// SPDX-License-Identifier: MIT
// Message: one received frame with its time, link and definition (class mavloom.Message).
// A field is decoded when it is read. Immutable; any thread.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <memory>
#include <string>

#include "mavloom/feed/link_names.hpp"
#include "mavloom/wire/frame.hpp"
#include "message/definitions.hpp"

namespace mavloom::python {

class MavutilStyle;

// Origin: the definitions of messages, and the names of the links on which they arrived. Any thread.
class Origin {
public:
    explicit Origin(std::shared_ptr<const Definitions> definitions, std::shared_ptr<MavutilStyle> style = nullptr)
        : definitions_(std::move(definitions)), style_(std::move(style)) {}
    // `dialect` is the argument of a Python function.
    explicit Origin(const nb::object& dialect) : Origin(definitions_of(dialect), style_of(dialect)) {}
    // Shares the definitions and links of `other`, but has another style.
    Origin(const Origin& other, std::shared_ptr<MavutilStyle> style)
        : definitions_(other.definitions_), style_(std::move(style)), link_names_(other.link_names_) {}

    [[nodiscard]] const std::shared_ptr<const Definitions>& definitions() const noexcept { return definitions_; }
    [[nodiscard]] const dialect::Dialect& dialect() const noexcept { return definitions_->dialect(); }
    // Not null if the messages are those of mavloom.mavutil (mavutil/field_message.hpp).
    [[nodiscard]] MavutilStyle* style() const noexcept { return style_.get(); }

    [[nodiscard]] feed::LinkNames& link_names() noexcept { return *link_names_; }
    // For a channel, which must not own the style: at the interpreter's end a channel may be leaked.
    [[nodiscard]] const std::shared_ptr<feed::LinkNames>& shared_link_names() const noexcept { return link_names_; }
    // Empty for a link that has no name.
    [[nodiscard]] std::string link_name(std::uint32_t link) const { return link_names_->find(LinkId{link}); }

private:
    std::shared_ptr<const Definitions> definitions_;
    std::shared_ptr<MavutilStyle> style_;
    std::shared_ptr<feed::LinkNames> link_names_ = std::make_shared<feed::LinkNames>();
};

struct Message {
    std::shared_ptr<const Origin> origin;
    const dialect::Message* definition = nullptr;  // null: an id without definition
    std::int64_t time_ns = 0;                      // Unix time
    std::uint32_t link = 0;
    std::uint16_t size = 0;
    std::uint8_t verdict = 0;  // of the signature check and, in a ring, of the router: see mavloom/ring/frames.hpp
    std::unique_ptr<const std::uint8_t[]> bytes;

    [[nodiscard]] wire::FrameView frame() const noexcept { return wire::FrameView::unchecked({bytes.get(), size}); }
};

// Returns a new Python object with a copy of the frame: a Message, or a message of mavloom.mavutil if the origin has
// that style. Call with the GIL held.
[[nodiscard]] nb::object make_message(const std::shared_ptr<const Origin>& origin, const dialect::Message* definition,
                                      std::int64_t time_ns, std::uint32_t link, const wire::FrameView& frame,
                                      std::uint8_t verdict = 0);

void bind_message(nb::module_& module);

}  // namespace mavloom::python
