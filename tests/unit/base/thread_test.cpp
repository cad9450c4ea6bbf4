// SPDX-License-Identifier: MIT
#include "mavloom/base/thread.hpp"

#include <gtest/gtest.h>

namespace mavloom {
namespace {

// sigaction(2): a fault that occurs while its signal is blocked ends the process, whatever handler is installed.
TEST(ThreadWithoutSignals, BlocksAllSignalsButThoseOfItsOwnFaults) {
    sigset_t mask;
    thread_without_signals([&] { ::pthread_sigmask(SIG_SETMASK, nullptr, &mask); }).join();

    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) EXPECT_EQ(::sigismember(&mask, signal), 1) << signal;
    for (const int fault : {SIGBUS, SIGSEGV, SIGFPE, SIGILL}) EXPECT_EQ(::sigismember(&mask, fault), 0) << fault;
}

}  // namespace
}  // namespace mavloom
