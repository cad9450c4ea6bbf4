// SPDX-License-Identifier: MIT
// A decoded frame: header and full payload, which can be changed and encoded again. Private to the module edit; lives
// on the stack and allocates nothing.
#pragma once

#include <array>
#include <optional>

#include "edit/plan.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::edit {

class Draft {
public:
    // Decodes the payload field by field if `message` covers all of it. Otherwise (no definition, or a longer payload)
    // keeps the payload as it is. Without a definition, derives the CRC_EXTRA from the frame's checksum. Returns empty
    // if there is no definition and no CRC_EXTRA fits the checksum.
    [[nodiscard]] static std::optional<Draft> of(const wire::FrameView& frame, const dialect::Message* message) noexcept;

    // `remap` and `set_version` return true if they changed the frame. `patch` returns true if it applied a patch.
    bool remap(const SystemMap& map) noexcept;
    bool patch(std::span<const Patch> patches) noexcept;
    bool set_version(wire::Version version) noexcept;
    void set_sequence(std::uint8_t sequence) noexcept { header_.sequence = sequence; }

    [[nodiscard]] bool decoded() const noexcept { return decoded_; }
    [[nodiscard]] bool fits_v1() const noexcept;
    [[nodiscard]] wire::Version version() const noexcept { return header_.version; }
    [[nodiscard]] Source source() const noexcept { return header_.source; }

    [[nodiscard]] wire::FrameView write(wire::FrameBuffer& out, wire::Signing signing) const noexcept;

private:
    Draft() = default;

    wire::FrameHeader header_;
    // The definition's info, with lengths increased to keep bytes beyond the definition.
    // Without definition, the values derived from the frame itself.
    wire::MessageInfo info_;
    std::array<std::uint8_t, wire::max_payload_length> payload_{};
    bool known_ = false, decoded_ = false;
};

}  // namespace mavloom::edit
