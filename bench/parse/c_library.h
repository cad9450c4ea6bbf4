/* SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct peer_result {
    uint64_t frames;
    uint64_t fingerprint; /* over checksum and id of each frame, in order */
    uint64_t dropped;
};

struct peer_result peer_parse(const uint8_t *bytes, size_t size);

#ifdef __cplusplus
}
#endif
