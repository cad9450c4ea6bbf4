// SPDX-License-Identifier: MIT
#include "mavloom/control/service_manager.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "support/temp_dir.hpp"

namespace mavloom::control {
namespace {

using namespace std::chrono_literals;

// Stands in for systemd: a socket, and the environment that names it.
class ServiceManagerTest : public testing::Test {
protected:
    void SetUp() override {
        const auto path = (dir_ / "notify").string();
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        ASSERT_LT(path.size(), sizeof address.sun_path);
        std::memcpy(address.sun_path, path.c_str(), path.size());
        socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        ASSERT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
        ::unsetenv("WATCHDOG_USEC");
        ::unsetenv("WATCHDOG_PID");
    }
    void TearDown() override {
        for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(name);
        ::close(socket_);
    }
    // Empty: nothing is there.
    [[nodiscard]] std::string received() const {
        std::array<char, 256> text;
        const auto size = ::recv(socket_, text.data(), text.size(), 0);
        return size < 0 ? std::string() : std::string(text.data(), static_cast<std::size_t>(size));
    }

private:
    test::TempDir dir_;
    int socket_ = -1;
};

TEST_F(ServiceManagerTest, SendsItsNotifications) {
    const auto manager = ServiceManager::from_environment();
    manager.ready();
    EXPECT_EQ(received(), "READY=1");
    manager.reloading();
    EXPECT_EQ(received().substr(0, 27), "RELOADING=1\nMONOTONIC_USEC=");
    manager.stopping();
    EXPECT_EQ(received(), "STOPPING=1");
}

TEST_F(ServiceManagerTest, FeedsTwiceInTheWatchdogsInterval) {
    ::setenv("WATCHDOG_USEC", "10000000", 1);
    ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
    auto manager = ServiceManager::from_environment();
    const MonoTime first = manager.watchdog_due();
    manager.feed(first);
    EXPECT_EQ(received(), "WATCHDOG=1");
    EXPECT_EQ(manager.watchdog_due(), first + 5s);

    manager.feed(first + 4999ms);
    EXPECT_EQ(received(), "");
    manager.feed(first + 5s);
    EXPECT_EQ(received(), "WATCHDOG=1");
}

TEST_F(ServiceManagerTest, WithoutAWatchdogNothingIsFed) {
    for (const char* interval : {"", "0", "-5", "x", "99999999999999999999"}) {
        ::setenv("WATCHDOG_USEC", interval, 1);
        auto manager = ServiceManager::from_environment();
        EXPECT_EQ(manager.watchdog_due(), MonoTime::max()) << interval;
        manager.feed(mono_now());
        EXPECT_EQ(received(), "") << interval;
    }
}

TEST_F(ServiceManagerTest, AnotherProcesssWatchdogIsNotOurs) {
    ::setenv("WATCHDOG_USEC", "10000000", 1);
    ::setenv("WATCHDOG_PID", "1", 1);

    EXPECT_EQ(ServiceManager::from_environment().watchdog_due(), MonoTime::max());
}

TEST_F(ServiceManagerTest, WithoutASocketThereAreNoNotifications) {
    for (const char* name : {"", "/", "@", "relative", "/nowhere/notify"}) {
        ::setenv("NOTIFY_SOCKET", name, 1);
        ::setenv("WATCHDOG_USEC", "10000000", 1);
        auto manager = ServiceManager::from_environment();
        manager.ready();
        EXPECT_EQ(manager.watchdog_due(), MonoTime::max()) << name;
    }
    EXPECT_EQ(received(), "");
}

TEST_F(ServiceManagerTest, MovesWithItsSocket) {
    auto first = ServiceManager::from_environment();
    const auto second = std::move(first);
    second.ready();

    EXPECT_EQ(received(), "READY=1");
}

}  // namespace
}  // namespace mavloom::control
