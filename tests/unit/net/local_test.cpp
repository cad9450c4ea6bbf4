// SPDX-License-Identifier: MIT
#include "mavloom/net/local.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cstring>
#include <string>

#include "mavloom/net/local_sender.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::net {
namespace {

using ::testing::HasSubstr;

// A sender that knows nothing of ours. `from`: its own address, "" for none; a leading NUL for an abstract one.
Fd sender(std::string_view from) {
    Fd fd(::socket(AF_UNIX, SOCK_DGRAM, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, from.data(), from.size());
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + from.size());
    if (!from.empty()) {
        EXPECT_EQ(::bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), length), 0);
    }
    return fd;
}

bool send(const Fd& fd, const std::filesystem::path& to, std::string_view bytes) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, to.c_str(), to.native().size());
    return ::sendto(fd.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address),
                    sizeof address) == static_cast<ssize_t>(bytes.size());
}

std::string text(ByteView bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

struct LocalSocketTest : ::testing::Test {
    test::TempDir dir;
    std::filesystem::path path = dir / "x.in";
};

TEST_F(LocalSocketTest, GivesBytesSenderAndTimeOfEachDatagram) {
    auto socket = LocalSocket::open(path, 0600);
    ASSERT_TRUE(socket) << socket.error().text;
    const std::string at_path = (dir / "a").string();
    const std::string_view abstract("\0mavloom-local-test", 19);
    const Fd bound = sender(at_path), hidden = sender(abstract), nobody = sender("");
    const WallTime before = wall_now();
    ASSERT_TRUE(send(bound, path, "one") && send(hidden, path, "") && send(nobody, path, "three"));

    ASSERT_EQ(socket->receive(), IoResult<std::size_t>(3u));
    EXPECT_EQ(text((*socket)[0].bytes), "one");
    EXPECT_EQ((*socket)[0].from, at_path);
    EXPECT_TRUE((*socket)[1].bytes.empty());
    EXPECT_EQ((*socket)[1].from, abstract);
    EXPECT_EQ(text((*socket)[2].bytes), "three");
    EXPECT_TRUE((*socket)[2].from.empty());
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_GE((*socket)[i].time, before);
        EXPECT_LE((*socket)[i].time, wall_now());
        EXPECT_EQ((*socket)[i].cut, 0u);
    }
    EXPECT_EQ(socket->receive(), IoResult<std::size_t>(tl::unexpected(IoError::would_block)));
}

TEST_F(LocalSocketTest, ReportsHowMuchOfADatagramItHasNoRoomFor) {
    auto socket = LocalSocket::open(path, 0600);
    ASSERT_TRUE(socket);
    const Fd nobody = sender("");
    const int bytes = 1 << 20;
    ::setsockopt(nobody.get(), SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
    ASSERT_TRUE(send(nobody, path, std::string(LocalSocket::slot_bytes, 'a')));
    if (!send(nobody, path, std::string(LocalSocket::slot_bytes + 7, 'b')))
        GTEST_SKIP() << "the system sends none so long";

    ASSERT_EQ(socket->receive(), IoResult<std::size_t>(2u));
    EXPECT_EQ((*socket)[0].bytes.size(), LocalSocket::slot_bytes);
    EXPECT_EQ((*socket)[0].cut, 0u);
    EXPECT_EQ((*socket)[1].bytes.size(), LocalSocket::slot_bytes);
    EXPECT_EQ((*socket)[1].cut, 7u);
}

TEST_F(LocalSocketTest, HasTheModeThatWasAskedForWhateverTheUmask) {
    for (const unsigned mode : {0600u, 0660u, 0666u}) {
        const auto umask_before = ::umask(0077);
        const auto socket = LocalSocket::open(path, mode);
        ::umask(umask_before);
        ASSERT_TRUE(socket) << socket.error().text;
        struct stat status {};
        ASSERT_EQ(::lstat(path.c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 0777u, mode);
        std::filesystem::remove(path);
    }
}

TEST_F(LocalSocketTest, RefusesATakenPlaceAndAPathThatIsTooLong) {
    const auto first = LocalSocket::open(path, 0600);
    ASSERT_TRUE(first);
    const auto second = LocalSocket::open(path, 0600);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, SetupCode::in_use);
    EXPECT_THAT(second.error().text, HasSubstr(path.string()));
    EXPECT_FALSE(LocalSocket::open(dir / std::string(200, 'x'), 0600));
}

// The kernel reports "refused" once, and not even that to a batch whose first datagrams went; from then on "not
// connected".
TEST_F(LocalSocketTest, ASenderWhoseFarSideWentGetsAnErrorEachTime) {
    auto far_side = LocalSocket::open(path, 0600);
    ASSERT_TRUE(far_side);
    auto near_side = LocalSender::connect(path);
    ASSERT_TRUE(near_side) << near_side.error().text;
    std::string bytes = "one";
    SendBatch batch;
    batch.room()[0] = {bytes.data(), bytes.size()};
    batch.add(nullptr, 1);
    ASSERT_EQ(near_side->send(batch, 0), IoResult<std::size_t>(1u));

    { const auto gone = std::move(far_side); }
    EXPECT_EQ(near_side->send(batch, 0), IoResult<std::size_t>(tl::unexpected(IoError::refused)));
    EXPECT_EQ(near_side->send(batch, 0), IoResult<std::size_t>(tl::unexpected(IoError::closed)));
    EXPECT_EQ(near_side->send(batch, 0), IoResult<std::size_t>(tl::unexpected(IoError::closed)));
}

}  // namespace
}  // namespace mavloom::net
