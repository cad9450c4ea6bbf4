// SPDX-License-Identifier: MIT
// The peer of `bench parse`: the C library's own parser, called byte by byte as its users do. pymavlink's mavgen generates
// the header from dialects/all.xml when the benchmark is built. Compiled as C, the language that the library is for.
#define MAVLINK_COMM_NUM_BUFFERS 1
#include "all/mavlink.h"

#include "c_library.h"

struct peer_result peer_parse(const uint8_t *bytes, size_t size)
{
    struct peer_result result = {0, 0, 0};
    mavlink_message_t message;
    mavlink_status_t status;
    mavlink_reset_channel_status(MAVLINK_COMM_0);
    for (size_t i = 0; i < size; i++) {
        if (mavlink_parse_char(MAVLINK_COMM_0, bytes[i], &message, &status) == MAVLINK_FRAMING_OK) {
            result.frames++;
            result.fingerprint = result.fingerprint * 31 + (message.checksum ^ message.msgid);
        }
    }
    result.dropped = mavlink_get_channel_status(MAVLINK_COMM_0)->packet_rx_drop_count;
    return result;
}
