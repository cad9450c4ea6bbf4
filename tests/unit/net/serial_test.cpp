// SPDX-License-Identifier: MIT
#include "mavloom/net/serial.hpp"

#include <gmock/gmock.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <thread>

#include "unit/net/pty.hpp"

namespace mavloom::net {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Pty;
using Bytes = std::vector<std::uint8_t>;

Bytes every_byte() {
    Bytes all(256);
    std::iota(all.begin(), all.end(), std::uint8_t{0});
    return all;
}

void await(int fd) {
    pollfd wanted{fd, POLLIN, 0};
    ASSERT_EQ(::poll(&wanted, 1, 5000), 1);
}

Bytes read_all(SerialPort& port, std::size_t count) {
    Bytes got;
    std::array<std::uint8_t, 4096> room;
    while (got.size() < count) {
        await(port.fd());
        const auto some = port.read(room);
        if (!some) break;
        got.insert(got.end(), room.begin(), room.begin() + static_cast<std::ptrdiff_t>(*some));
    }
    return got;
}

Result<std::size_t, IoError> write(SerialPort& port, Bytes bytes) {
    const iovec piece{bytes.data(), bytes.size()};
    return port.write({&piece, 1});
}

TEST(SerialPort, PassesEveryByteBothWays) {
    const Pty far;
    SerialPort port = std::move(*SerialPort::open(far.device(), {}));
    far.write(every_byte());
    EXPECT_EQ(read_all(port, 256), every_byte());
    EXPECT_EQ(write(port, every_byte()).value_or(0), 256u);
    far.await();
    EXPECT_EQ(far.read(), every_byte());
    std::array<std::uint8_t, 8> room;
    EXPECT_EQ(port.read(room).error(), IoError::would_block);
}

TEST(SerialPort, TakesAnyBaudRate) {
    const Pty far;
    SerialPort port = std::move(*SerialPort::open(far.device(), {123'457}));
    EXPECT_EQ(port.baud(), 123'457u);
    EXPECT_EQ(far.settings().c_ospeed, 123'457u);
    EXPECT_EQ(far.settings().c_cflag & CRTSCTS, 0u);
    EXPECT_TRUE(port.set_baud(921'600));
    EXPECT_EQ(far.settings().c_ospeed, 921'600u);
}

TEST(SerialPort, SetsFlowControlWhereAsked) {
    const Pty far;
    const SerialPort port = std::move(*SerialPort::open(far.device(), {57'600, true}));
    EXPECT_NE(far.settings().c_cflag & CRTSCTS, 0u);
    EXPECT_EQ(far.settings().c_iflag & (IXON | IXOFF), 0u);
}

TEST(SerialPort, IsNotSharedUnawares) {
    const Pty far;
    auto first = SerialPort::open(far.device(), {});
    ASSERT_TRUE(first);
    const auto second = SerialPort::open(far.device(), {});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, SetupCode::in_use);
    EXPECT_THAT(second.error().text, HasSubstr(far.device()));
    first->close();
    EXPECT_TRUE(SerialPort::open(far.device(), {}));
}

TEST(SerialPort, RefusesOtherDevices) {
    EXPECT_EQ(SerialPort::open("/dev/no-such-port", {}).error().code, SetupCode::not_found);
    EXPECT_EQ(SerialPort::open("/dev", {}).error().code, SetupCode::usage);
    const auto null = SerialPort::open("/dev/null", {});
    ASSERT_FALSE(null);
    EXPECT_EQ(null.error().code, SetupCode::usage);
    EXPECT_EQ(null.error().text, "/dev/null is not a serial port");
}

TEST(SerialPort, ReportsThatItWasUnplugged) {
    Pty far;
    SerialPort port = std::move(*SerialPort::open(far.device(), {}));
    far.unplug();
    std::array<std::uint8_t, 8> room;
    const auto read = port.read(room);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error(), IoError::would_block);
    const auto written = write(port, {1, 2, 3});
    ASSERT_FALSE(written);
    EXPECT_NE(written.error(), IoError::would_block);
    EXPECT_EQ(port.unsent_bytes(), 0u);
}

TEST(SerialPort, AFullOneTakesNoMore) {
    const Pty far;
    SerialPort port = std::move(*SerialPort::open(far.device(), {}));
    Result<std::size_t, IoError> written = 0;
    for (int i = 0; i < 1000 && written; ++i) written = write(port, Bytes(1000));
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error(), IoError::would_block);
}

// Files stand for devices here: only names matter.
struct SerialNames : ::testing::Test {
    SerialNames() {
        fs::create_directories(root / "by-id");
        make("ttyACM0");
    }
    ~SerialNames() override { fs::remove_all(root); }
    void make(const std::string& name) const { std::ofstream(root / name) << name; }
    void link(const std::string& id, const std::string& to) const {
        fs::remove(root / "by-id" / id);
        fs::create_symlink("../" + to, root / "by-id" / id);
    }
    [[nodiscard]] std::string at(const std::string& name) const { return (root / name).string(); }

    fs::path root = fs::path(::testing::TempDir()) / ("serial_names_" + std::to_string(::getpid()));
    SerialDevice device{at("ttyACM0"), at("by-id")};
};

TEST_F(SerialNames, ADeviceWithoutLinkIsSoughtUnderItsName) {
    device.note_opened(at("ttyACM0"));
    EXPECT_THAT(device.id_link(), IsEmpty());
    EXPECT_THAT(device.places(), ElementsAre(at("ttyACM0")));
}

TEST_F(SerialNames, ItsLinkLeadsToItsNewNumber) {
    link("usb-Autopilot", "ttyACM0");
    device.note_opened(at("ttyACM0"));
    EXPECT_EQ(device.id_link(), at("by-id/usb-Autopilot"));
    EXPECT_THAT(device.places(), ElementsAre(at("ttyACM0")));
    fs::remove(root / "ttyACM0");
    make("ttyACM1");
    link("usb-Autopilot", "ttyACM1");
    EXPECT_THAT(device.places(), ElementsAre(at("by-id/usb-Autopilot")));
}

TEST_F(SerialNames, AnotherDeviceUnderItsNameIsNotTakenForIt) {
    link("usb-Autopilot", "ttyACM0");
    device.note_opened(at("ttyACM0"));
    make("ttyACM1");
    link("usb-Autopilot", "ttyACM1");
    link("usb-Other", "ttyACM0");
    EXPECT_THAT(device.places(), ElementsAre(at("by-id/usb-Autopilot")));
}

TEST_F(SerialNames, ANewDeviceWithoutItsLinkHasAMomentToGetIt) {
    link("usb-Autopilot", "ttyACM0");
    device.note_opened(at("ttyACM0"));
    fs::remove(root / "by-id/usb-Autopilot");
    fs::remove(root / "ttyACM0");
    EXPECT_THAT(device.places(), ElementsAre(at("ttyACM0")));
    make("ttyACM0");
    EXPECT_THAT(device.places(), IsEmpty());
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (device.places().empty() && std::chrono::steady_clock::now() < deadline)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_THAT(device.places(), ElementsAre(at("ttyACM0")));
}

TEST_F(SerialNames, ItsFoldersAreThoseThatExist) {
    EXPECT_THAT(device.folders(), ElementsAre(root.string(), at("by-id")));
    fs::remove(root / "by-id");
    EXPECT_THAT(device.folders(), ElementsAre(root.string()));
    fs::create_symlink(at("by-path-missing/0"), root / "link");
    EXPECT_THAT(SerialDevice(at("link"), at("by-id")).folders(), ElementsAre(root.string()));
}

TEST_F(SerialNames, AFolderReportsNewNames) {
    FolderWatch watch = std::move(*FolderWatch::create());
    watch.add(root.string());
    watch.add("/no/such/folder");
    pollfd wanted{watch.fd(), POLLIN, 0};
    EXPECT_EQ(::poll(&wanted, 1, 0), 0);
    make("ttyACM1");
    EXPECT_EQ(::poll(&wanted, 1, 5000), 1);
    watch.drain();
    EXPECT_EQ(::poll(&wanted, 1, 0), 0);
}

}  // namespace
}  // namespace mavloom::net
