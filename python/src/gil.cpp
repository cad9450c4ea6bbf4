// SPDX-License-Identifier: MIT
#include "gil.hpp"

#include <pthread.h>

namespace mavloom::python {

[[maybe_unused]] static const int registered = ::pthread_atfork(nullptr, nullptr, WithoutGil::forked);

}  // namespace mavloom::python
