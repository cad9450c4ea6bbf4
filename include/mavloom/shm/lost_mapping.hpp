// SPDX-License-Identifier: MIT
// Lets a program survive when another process shortens the file of a ring or counter page that the program has mapped.
//
// The kernel then sends SIGBUS at the next access. The library installs no signal handlers. A program that wants to
// survive calls `replace_lost_mapping` from its own handler for SIGBUS (apps/mavloom/signals.cpp).
#pragma once

namespace mavloom::shm {

// Async-signal-safe; any thread. If `address` is in a mapping of this library, replaces the whole mapping with
// zero-filled private memory, so that the access succeeds, and returns true. The ring then counts as removed: its
// writer gets `removed`, its readers get `retired`. The counter page counts as removed too. Returns false for any other
// address, and if the kernel has no memory.
[[nodiscard]] bool replace_lost_mapping(void* address) noexcept;

// Call it once a handler for SIGBUS that calls `replace_lost_mapping` is installed. Before that, readers refuse rings
// that users other than the owner may write (Trust::foreign).
void survives_lost_mappings() noexcept;

}  // namespace mavloom::shm
