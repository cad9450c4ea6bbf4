// SPDX-License-Identifier: MIT
// Decodes one frame of its own dialect and writes it again. The frame was made by pymavlink's generator from shop.xml:
// SHELF_STATUS, sequence 7, system 42, component 1, state FULL, 513 items, 2.5 kg.
#include <cstdio>
#include <cstring>

#include "mavloom/wire/datagram_parser.hpp"
#include "mavloom/wire/frame_writer.hpp"
#include "shop/msg/dialect.hpp"
#include "shop/msg/enums/shelf_state.hpp"
#include "shop/msg/heartbeat.hpp"
#include "shop/msg/shelf_names.hpp"
#include "shop/msg/shelf_status.hpp"

using shop::msg::ShelfStatus;

constexpr std::uint8_t frame[] = {0xfd, 0x07, 0x00, 0x00, 0x07, 0x2a, 0x01, 0xcb, 0xc3, 0x00,
                                  0x00, 0x00, 0x20, 0x40, 0x01, 0x02, 0x03, 0xd1, 0xa9};

// Every member is itself, whatever its name means inside the struct.
bool names_are_members() {
    shop::msg::ShelfNames names;
    names.out_ = 1;
    names.payload = 2;
    names.message = 3;
    names.std_ = 4;
    names.max_length_ = {5, 6, 7};
    std::array<std::uint8_t, shop::msg::ShelfNames::max_length> payload;
    names.encode(payload);
    const std::array<std::uint8_t, 11> expected{1, 2, 0, 3, 4, 0,
                                                0, 0, 5, 6, 7};  // all one byte wide: the order of the definition
    return payload == expected && shop::msg::ShelfNames::decode(payload) == names;
}

int main() {
    if (!names_are_members()) return 2;
    const auto& dialect = shop::msg::dialect();
    if (dialect.find(shop::msg::Heartbeat::id) == nullptr) return 1;  // of minimal.xml, which is not beside shop.xml
    bool same = false;

    mavloom::wire::DatagramParser parser(dialect.wire_table());
    parser.parse(frame, [&](const mavloom::wire::ParseEvent& event) {
        if (event.kind != mavloom::wire::ParseEvent::Kind::frame || event.info == nullptr) return;
        const auto status = ShelfStatus::decode(event.frame.payload());
        std::printf("state=%d items=%d weight=%g\n", static_cast<int>(status.state), status.items,
                    static_cast<double>(status.weight));

        mavloom::wire::FrameBuffer out;
        std::array<std::uint8_t, ShelfStatus::max_length> payload;
        status.encode(payload);
        const auto written = write_frame(out, {.sequence = event.frame.sequence(), .source = event.frame.source()},
                                         *event.info, payload);
        same = written.size() == sizeof frame && std::memcmp(written.bytes().data(), frame, sizeof frame) == 0;
    });
    std::printf("re-encoded: %s\n", same ? "same bytes" : "other bytes");
    return same ? 0 : 1;
}
