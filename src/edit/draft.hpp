// SPDX-License-Identifier: MIT
// A frame taken apart: header and full payload, to be changed and written again. Private to module edit; lives on the stack, allocates nothing.
#pragma once

#include <array>
#include <optional>

#include "edit/plan.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::edit {

class Draft {
public:
    // Decodes the payload field by field where `message` defines all of it; otherwise (no definition, or bytes beyond it) takes it as it is, with
    // the CRC_EXTRA that the checksum shows. Empty for a frame whose checksum fits no CRC_EXTRA.
    [[nodiscard]] static std::optional<Draft> of(const wire::FrameView& frame, const dialect::Message* message) noexcept;

    // Each says whether it changed something.
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
    // The definition's, its lengths widened to keep bytes beyond it; without one what the frame itself shows.
    wire::MessageInfo info_;
    std::array<std::uint8_t, wire::max_payload_length> payload_{};
    bool known_ = false, decoded_ = false;
};

}  // namespace mavloom::edit
