// SPDX-License-Identifier: MIT
#include "sim/store/file_service.hpp"

#include "sim/parts.hpp"

namespace mavloom::sim {

std::span<const MessageId> FileService::handled() const noexcept { return {}; }

void FileService::receive(const Client& /*from*/, MessageId /*id*/, ByteView /*payload*/, Moment /*now*/) { (void)parts_; }

}  // namespace mavloom::sim
