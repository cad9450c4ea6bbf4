// SPDX-License-Identifier: MIT
// MAVLink FTP as a client sees it. Expected answers: MAVLink guide, "File Transfer Protocol (FTP)", and the recorded
// session with PX4 in tests/data/px4_gcs_session.tlog.
#include <gmock/gmock.h>

#include <cerrno>
#include <set>

#include "mavloom/msg/enums/mav_ftp_err.hpp"
#include "mavloom/msg/enums/mav_ftp_opcode.hpp"
#include "mavloom/msg/file_transfer_protocol.hpp"
#include "mavloom/wire/crc32.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim::file_tests {
namespace {

using namespace msg;
using test::Peer;
using test::Rig;
using testing::Contains;
using testing::ElementsAre;
using Bytes = std::vector<std::uint8_t>;

struct FtpReply {
    std::uint16_t seq = 0;
    std::uint8_t session = 0, opcode = 0, request = 0;
    bool burst_complete = false;
    std::uint32_t offset = 0;
    Bytes data;

    [[nodiscard]] bool is_ack() const { return opcode == MAV_FTP_OPCODE_ACK; }
    // The error of a NAK; 0 for an ACK.
    [[nodiscard]] int error() const { return is_ack() ? 0 : data.at(0); }
    [[nodiscard]] int number() const { return data.size() > 1 ? data[1] : 0; }  // of FailErrno
    [[nodiscard]] std::uint32_t value() const { return data.size() == 4 ? load_le<std::uint32_t>(data.data()) : ~0u; }
};

FtpReply reply_of(const FileTransferProtocol& message) {
    const std::uint8_t* const at = message.payload.data();
    return {.seq = load_le<std::uint16_t>(at),
            .session = at[2],
            .opcode = at[3],
            .request = at[5],
            .burst_complete = at[6] != 0,
            .offset = load_le<std::uint32_t>(at + 8),
            .data = {at + 12, at + 12 + at[4]}};
}

Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

VehicleOptions options_of(Autopilot autopilot) {
    VehicleOptions options;
    options.autopilot = autopilot;
    options.utc_at_start = WallTime{std::chrono::seconds{1795222314}};  // 2026-11-21 00:51:54 UTC
    return options;
}

// A client of one vehicle.
class FtpClient {
public:
    explicit FtpClient(Rig& rig, const Peer& peer = {}) : rig_(rig), peer_(peer) {}

    void send(std::uint8_t opcode, const Bytes& data, std::uint8_t session = 0, std::uint32_t offset = 0, int size = -1) {
        FileTransferProtocol message{.target_system = 1, .target_component = 1};
        std::uint8_t* const at = message.payload.data();
        store_le(at, seq);
        at[2] = session;
        at[3] = opcode;
        at[4] = static_cast<std::uint8_t>(size < 0 ? static_cast<int>(data.size()) : size);
        store_le(at + 8, offset);
        std::copy(data.begin(), data.end(), at + 12);
        rig_.send(message, peer_);
        ++seq;
    }
    std::vector<FtpReply> replies() const {
        std::vector<FtpReply> all;
        for (const auto& message : rig_.all<FileTransferProtocol>(peer_.link))
            if (message.target_system == peer_.id.system.value && message.target_component == peer_.id.component.value)
                all.push_back(reply_of(message));
        return all;
    }
    // The only reply to a request, which must carry its sequence number, session and opcode.
    FtpReply ask(std::uint8_t opcode, const Bytes& data, std::uint8_t session = 0, std::uint32_t offset = 0,
                 int size = -1) {
        const std::size_t before = replies().size();
        send(opcode, data, session, offset, size);
        const auto all = replies();
        EXPECT_EQ(all.size(), before + 1);
        if (all.size() == before) return {};
        const FtpReply reply = all.back();
        EXPECT_EQ(reply.seq, seq);
        EXPECT_EQ(reply.session, session);
        EXPECT_EQ(reply.request, opcode);
        EXPECT_EQ(reply.offset, offset);
        return reply;
    }
    FtpReply ask(std::uint8_t opcode, std::string_view path, std::uint8_t session = 0, std::uint32_t offset = 0) {
        return ask(opcode, bytes_of(path), session, offset);
    }
    std::vector<std::string> list(std::string_view path, std::uint8_t opcode = MAV_FTP_OPCODE_LISTDIRECTORY) {
        std::vector<std::string> entries;
        for (;;) {
            const FtpReply reply = ask(opcode, path, 0, static_cast<std::uint32_t>(entries.size()));
            if (!reply.is_ack()) {
                EXPECT_EQ(reply.error(), MAV_FTP_ERR_EOF);
                return entries;
            }
            std::string_view rest(reinterpret_cast<const char*>(reply.data.data()), reply.data.size());
            while (!rest.empty()) {
                const std::size_t end = rest.find('\0');
                EXPECT_NE(end, std::string_view::npos) << "each entry ends with a NUL";
                entries.emplace_back(rest.substr(0, end));
                rest.remove_prefix(end + 1);
            }
        }
    }
    Bytes download(std::string_view path, std::uint8_t session = 0) {
        const FtpReply opened = ask(MAV_FTP_OPCODE_OPENFILERO, path, session);
        EXPECT_TRUE(opened.is_ack()) << path;
        Bytes content;
        while (opened.is_ack()) {
            const auto offset = static_cast<std::uint32_t>(content.size());
            const FtpReply piece = ask(MAV_FTP_OPCODE_READFILE, Bytes{}, session, offset, 239);
            if (!piece.is_ack()) {
                EXPECT_EQ(piece.error(), MAV_FTP_ERR_EOF);
                break;
            }
            content.insert(content.end(), piece.data.begin(), piece.data.end());
        }
        EXPECT_EQ(content.size(), opened.value());
        EXPECT_TRUE(ask(MAV_FTP_OPCODE_TERMINATESESSION, Bytes{}, session).is_ack());
        return content;
    }
    void upload(std::string_view path, const Bytes& content) {
        EXPECT_TRUE(ask(MAV_FTP_OPCODE_CREATEFILE, path).is_ack());
        for (std::size_t at = 0; at < content.size(); at += 239) {
            const Bytes piece(content.begin() + static_cast<std::ptrdiff_t>(at),
                              content.begin() + static_cast<std::ptrdiff_t>(std::min(at + 239, content.size())));
            EXPECT_EQ(ask(MAV_FTP_OPCODE_WRITEFILE, piece, 0, static_cast<std::uint32_t>(at)).value(), piece.size());
        }
        EXPECT_TRUE(ask(MAV_FTP_OPCODE_TERMINATESESSION, Bytes{}).is_ack());
    }

    std::uint16_t seq = 0;

private:
    Rig& rig_;
    Peer peer_;
};

class FileService : public testing::Test {
protected:
    Rig rig{options_of(Autopilot::px4)};
    FtpClient ftp{rig};
};

// --- Directories

TEST_F(FileService, ListsDirectoriesUntilTheEnd) {
    EXPECT_THAT(ftp.list("/"), ElementsAre("Detc", "Dlog"));
    EXPECT_THAT(ftp.list(""), ElementsAre("Detc", "Dlog"));
    EXPECT_THAT(ftp.list("/etc"), ElementsAre("Dextras"));
    const auto files = ftp.list("/etc/extras/");
    ASSERT_EQ(files.size(), 4u);
    EXPECT_THAT(files[0], testing::StartsWith("Factuators.json.xz\t"));
    EXPECT_THAT(files[2], testing::StartsWith("Fcomponent_general.json.xz\t"));
}

TEST_F(FileService, ListsAsManyEntriesAsFitIntoAReply) {
    for (int i = 0; i < 40; ++i) ftp.upload("/a_file_with_a_rather_long_name_" + std::to_string(i), {});

    const auto entries = ftp.list("/");

    EXPECT_EQ(entries.size(), 42u);
    EXPECT_EQ(std::set<std::string>(entries.begin(), entries.end()).size(), 42u) << "no entry comes twice";
}

TEST_F(FileService, ListsWithTimes) {
    EXPECT_THAT(ftp.list("/log", MAV_FTP_OPCODE_LISTDIRECTORYWITHTIME),
                ElementsAre("D2026-11-20\t0\t1795218714", "D2026-11-21\t0\t1795222314"));
    const auto newest = ftp.list("/log/2026-11-21", MAV_FTP_OPCODE_LISTDIRECTORYWITHTIME);
    ASSERT_EQ(newest.size(), 1u);
    EXPECT_THAT(newest[0], testing::MatchesRegex("F00_51_54.ulg\t[0-9]+\t1795222314"));
}

TEST_F(FileService, RefusesToListWhatIsNoDirectory) {
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_LISTDIRECTORY, "/nowhere").error(), MAV_FTP_ERR_FILENOTFOUND);
    const FtpReply file = ftp.ask(MAV_FTP_OPCODE_LISTDIRECTORY, "/etc/extras/actuators.json.xz");
    EXPECT_EQ(file.error(), MAV_FTP_ERR_FAILERRNO);
    EXPECT_EQ(file.number(), ENOTDIR);
}

// --- Reading

TEST_F(FileService, ReadsAFileByEveryFormOfItsPath) {
    const Bytes content = ftp.download("/etc/extras/component_general.json.xz");
    EXPECT_THAT(content, testing::Not(testing::IsEmpty()));
    for (const char* path : {"etc/extras/component_general.json.xz", "mftp://etc/extras/component_general.json.xz",
                             "mftp:///etc/extras/component_general.json.xz", "//etc/./extras//component_general.json.xz",
                             "mftp://[;comp=1]etc/extras/component_general.json.xz"})
        EXPECT_EQ(ftp.download(path), content) << path;
    auto with_end = bytes_of("/etc/extras/component_general.json.xz");
    with_end.push_back(0);
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_OPENFILERO, with_end).value(), content.size());
}

TEST_F(FileService, AnswersMissingFilesAtOnce) {
    for (const char* path :
         {"/no/such/file", "@PARAM/param.pck?withdefaults=1", "@MISSION/mission.dat", "@SYS/threads.txt"})
        EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_OPENFILERO, path).error(), MAV_FTP_ERR_FILENOTFOUND) << path;
    const FtpReply directory = ftp.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc");
    EXPECT_EQ(directory.error(), MAV_FTP_ERR_FAILERRNO);
    EXPECT_EQ(directory.number(), EISDIR);
}

TEST_F(FileService, RefusesPathsAboveTheRoot) {
    for (const char* path : {"..", "/../etc/passwd", "etc/../../secret", "a/..", "/log/../../x"})
        for (const std::uint8_t opcode :
             {MAV_FTP_OPCODE_OPENFILERO, MAV_FTP_OPCODE_CREATEFILE, MAV_FTP_OPCODE_LISTDIRECTORY,
              MAV_FTP_OPCODE_REMOVEFILE, MAV_FTP_OPCODE_CALCFILECRC, MAV_FTP_OPCODE_CREATEDIRECTORY,
              MAV_FTP_OPCODE_TRUNCATEFILE})
            EXPECT_EQ(ftp.ask(opcode, path).error(), MAV_FTP_ERR_FILEPROTECTED) << path << " " << int{opcode};
}

TEST_F(FileService, EchoesTheSessionThatTheClientChose) {
    const Bytes content = ftp.download("/etc/extras/actuators.json.xz", 0);

    EXPECT_EQ(ftp.download("/etc/extras/actuators.json.xz", 1), content);
    EXPECT_EQ(ftp.download("/etc/extras/actuators.json.xz", 255), content);
}

TEST_F(FileService, ChecksSessions) {
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_READFILE, Bytes{}, 3, 0, 100).error(), MAV_FTP_ERR_INVALIDSESSION);
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_BURSTREADFILE, Bytes{}, 3, 0, 100).error(), MAV_FTP_ERR_INVALIDSESSION);
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_WRITEFILE, Bytes{1}, 3).error(), MAV_FTP_ERR_INVALIDSESSION);
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_TERMINATESESSION, Bytes{}, 3).error(), MAV_FTP_ERR_INVALIDSESSION);
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc/extras/actuators.json.xz", 3).is_ack());
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_WRITEFILE, Bytes{1}, 3).error(), MAV_FTP_ERR_INVALIDSESSION) << "open for reading";
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_RESETSESSION, Bytes{}).is_ack());
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_READFILE, Bytes{}, 3, 0, 100).error(), MAV_FTP_ERR_INVALIDSESSION);
}

TEST_F(FileService, ClosesASessionAfterTenSecondsOfSilence) {
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc/extras/actuators.json.xz").is_ack());
    rig.run(9.9);
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_READFILE, Bytes{}, 0, 0, 100).is_ack());
    rig.run(9.9);
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_READFILE, Bytes{}, 0, 100, 100).is_ack());

    rig.run(10.1);

    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_READFILE, Bytes{}, 0, 200, 100).error(), MAV_FTP_ERR_INVALIDSESSION);
}

TEST_F(FileService, LimitsTheSessionsOfAClient) {
    const std::size_t most = Limits{}.file_sessions;
    for (std::size_t i = 0; i < most; ++i)
        ASSERT_TRUE(
            ftp.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc/extras/actuators.json.xz", static_cast<std::uint8_t>(i)).is_ack());

    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc/extras/actuators.json.xz", 99).error(),
              MAV_FTP_ERR_NOSESSIONSAVAILABLE);
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_CREATEFILE, "/new", 99).error(), MAV_FTP_ERR_NOSESSIONSAVAILABLE);
    EXPECT_THAT(ftp.list("/"), testing::Not(Contains(testing::StartsWith("Fnew"))));
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc/extras/actuators.json.xz", 0).is_ack()) << "opens it again";
    FtpClient other(rig, {LinkId{1}, {SystemId{1}, ComponentId{195}}});
    EXPECT_TRUE(other.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc/extras/actuators.json.xz", 99).is_ack());
}

TEST_F(FileService, LimitsTheClients) {
    VehicleOptions options = options_of(Autopilot::px4);
    options.limits.clients = 2;
    Rig small(options);
    FtpClient first(small, {LinkId{1}, {SystemId{201}, ComponentId{1}}});
    FtpClient second(small, {LinkId{1}, {SystemId{202}, ComponentId{1}}});
    FtpClient third(small, {LinkId{1}, {SystemId{203}, ComponentId{1}}});
    first.list("/");
    second.list("/");

    EXPECT_EQ(third.ask(MAV_FTP_OPCODE_LISTDIRECTORY, "/").error(), MAV_FTP_ERR_NOSESSIONSAVAILABLE);
    small.run(10.5);
    EXPECT_EQ(third.list("/").size(), 2u) << "the others have been silent";
}

TEST_F(FileService, AClientWithManyIdsKeepsNoOtherLinkOut) {
    VehicleOptions options = options_of(Autopilot::px4);
    options.limits.clients = 2;
    Rig small(options);
    small.vehicle.open(LinkId{2}, {}, small.now());
    for (const auto system : {std::uint8_t{201}, std::uint8_t{202}})
        FtpClient(small, {LinkId{1}, {SystemId{system}, ComponentId{1}}}).list("/");

    FtpClient other(small, {LinkId{2}, {SystemId{201}, ComponentId{1}}});

    EXPECT_EQ(other.list("/").size(), 2u);
}

TEST_F(FileService, GivesTheSameReplyToTheSameRequest) {
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_CREATEFILE, "/once").is_ack());
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_REMOVEFILE, "/once").is_ack());

    --ftp.seq;
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_REMOVEFILE, "/once").is_ack()) << "it was not carried out twice";
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_REMOVEFILE, "/once").error(), MAV_FTP_ERR_FILENOTFOUND);
    --ftp.seq;
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_LISTDIRECTORY, "/nowhere").request, MAV_FTP_OPCODE_LISTDIRECTORY)
        << "another request with that number is another request";
}

TEST_F(FileService, ALaterRequestThatLooksAlikeIsANewOne) {
    ftp.upload("/file", bytes_of("old"));
    const std::uint16_t seq = ftp.seq;
    const std::uint32_t before = ftp.ask(MAV_FTP_OPCODE_CALCFILECRC, "/file").value();
    FtpClient other(rig, {.id = {SystemId{254}, ComponentId{1}}});
    other.upload("/file", bytes_of("new"));
    rig.run(3.0);

    ftp.seq = seq;
    EXPECT_NE(ftp.ask(MAV_FTP_OPCODE_CALCFILECRC, "/file").value(), before);
}

TEST_F(FileService, EveryNameThatItTakesFitsAListing) {
    constexpr int name_too_long = 36;  // ENAMETOOLONG
    const std::string longest(199, 'a'), longer(236, 'b');
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_CREATEFILE, "/" + longest).is_ack());
    ftp.upload("/z", {});
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_CREATEFILE, "/" + longer).number(), name_too_long);
    EXPECT_THAT(ftp.list("/"), Contains(testing::StartsWith("Fz")));
}

TEST_F(FileService, AFolderMovesOnlyWhereAllItsPathsFit) {
    constexpr int name_too_long = 36;
    const std::string name(150, 'a');
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_CREATEDIRECTORY, "/f").is_ack());
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_CREATEFILE, "/f/" + name).is_ack());
    Bytes paths = bytes_of("/f");
    paths.push_back(0);
    const Bytes to = bytes_of("/" + std::string(120, 'g'));
    paths.insert(paths.end(), to.begin(), to.end());
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_RENAME, paths).number(), name_too_long);
}

TEST_F(FileService, RefusesUnknownOperationsAndSizes) {
    EXPECT_EQ(ftp.ask(17, Bytes{}).error(), MAV_FTP_ERR_UNKNOWNCOMMAND);
    EXPECT_EQ(ftp.ask(127, Bytes{}).error(), MAV_FTP_ERR_UNKNOWNCOMMAND);
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_LISTDIRECTORY, bytes_of("/"), 0, 0, 240).error(), MAV_FTP_ERR_INVALIDDATASIZE);
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_NONE, Bytes{}).is_ack());
    ftp.send(MAV_FTP_OPCODE_ACK, {});
    ftp.send(MAV_FTP_OPCODE_NAK, {1});
    EXPECT_EQ(ftp.replies().size(), 4u) << "replies of others are no requests";
}

// --- Burst

TEST_F(FileService, StreamsABurstUntilTheEndOfTheFile) {
    const Bytes content = ftp.download("/etc/extras/parameters.json.xz");
    ASSERT_GT(content.size(), 500u);
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc/extras/parameters.json.xz").is_ack());
    rig.forget();

    const std::uint16_t first = ftp.seq;
    ftp.send(MAV_FTP_OPCODE_BURSTREADFILE, {}, 0, 0, 239);
    rig.run(1.0);

    Bytes got;
    auto replies = ftp.replies();
    for (std::size_t i = 0; i < replies.size(); ++i) {
        EXPECT_EQ(replies[i].seq, first + 1 + i);
        EXPECT_EQ(replies[i].offset, got.size());
        EXPECT_EQ(replies[i].request, MAV_FTP_OPCODE_BURSTREADFILE);
        if (i + 1 < replies.size()) got.insert(got.end(), replies[i].data.begin(), replies[i].data.end());
    }
    EXPECT_EQ(got, content);
    EXPECT_EQ(replies.back().error(), MAV_FTP_ERR_EOF);
}

TEST_F(FileService, EndsABurstAfter168RepliesAsPx4Does) {
    const auto log = "/log/2026-11-21/" + ftp.list("/log/2026-11-21").at(0).substr(1, 12);
    const std::uint32_t size = ftp.ask(MAV_FTP_OPCODE_OPENFILERO, log).value();
    ASSERT_GT(size, 168u * 80);
    rig.forget();

    ftp.send(MAV_FTP_OPCODE_BURSTREADFILE, {}, 0, 0, 80);
    rig.run(1.0);

    const auto replies = ftp.replies();
    ASSERT_EQ(replies.size(), 168u);
    EXPECT_TRUE(replies.back().burst_complete);
    EXPECT_EQ(std::ranges::count_if(replies, &FtpReply::burst_complete), 1);
    EXPECT_EQ(replies.back().data.size(), 80u);
}

TEST_F(FileService, ReadsAGapWhileABurstRuns) {
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc/extras/parameters.json.xz").is_ack());
    rig.sink.full = {1};
    ftp.send(MAV_FTP_OPCODE_BURSTREADFILE, {}, 0, 0, 239);
    rig.run(0.1);
    rig.forget();

    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_READFILE, Bytes{}, 0, 239, 100).data.size(), 100u);
    EXPECT_EQ(ftp.replies().size(), 1u) << "the burst waits while the link's queue is long";
    rig.sink.full = {};
    rig.run(0.5);
    EXPECT_EQ(ftp.replies().back().error(), MAV_FTP_ERR_EOF);
}

TEST_F(FileService, DoesNotRestartABurstThatRuns) {
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc/extras/parameters.json.xz").is_ack());
    rig.sink.full = {1};
    ftp.send(MAV_FTP_OPCODE_BURSTREADFILE, {}, 0, 0, 239);
    rig.run(0.5);
    --ftp.seq;
    ftp.send(MAV_FTP_OPCODE_BURSTREADFILE, {}, 0, 0, 239);
    rig.forget();

    rig.sink.full = {};
    rig.run(0.5);

    std::set<std::uint32_t> offsets;
    for (const FtpReply& reply : ftp.replies()) EXPECT_TRUE(offsets.insert(reply.offset).second) << reply.offset;
}

TEST_F(FileService, PacesBurstsAtOneToTwoMegabytesASecond) {
    const std::string log = "/log/2026-11-20/" + ftp.list("/log/2026-11-20").at(0).substr(1, 12);
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_OPENFILERO, log).is_ack());
    rig.forget();
    ftp.send(MAV_FTP_OPCODE_BURSTREADFILE, {}, 0, 0, 239);
    rig.run(0.025);

    EXPECT_LE(ftp.replies().size(), 3u * 56);
    EXPECT_GE(ftp.replies().size(), 56u);
}

TEST_F(FileService, ServesTwoClientsSideBySide) {
    FtpClient other(rig, {LinkId{1}, {SystemId{245}, ComponentId{190}}});
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc/extras/parameters.json.xz").is_ack());
    ASSERT_TRUE(other.ask(MAV_FTP_OPCODE_OPENFILERO, "/etc/extras/actuators.json.xz").is_ack());
    rig.forget();
    ftp.send(MAV_FTP_OPCODE_BURSTREADFILE, {}, 0, 0, 239);
    other.send(MAV_FTP_OPCODE_BURSTREADFILE, {}, 0, 0, 239);
    rig.run(1.0);

    EXPECT_EQ(ftp.replies().back().error(), MAV_FTP_ERR_EOF);
    EXPECT_EQ(other.replies().back().error(), MAV_FTP_ERR_EOF);
    EXPECT_NE(ftp.replies().back().offset, other.replies().back().offset);
}

// --- Writing

TEST_F(FileService, StoresWhatAClientWrites) {
    Bytes content(1000);
    for (std::size_t i = 0; i < content.size(); ++i) content[i] = static_cast<std::uint8_t>(i * 7);

    ftp.upload("/notes.txt", content);

    EXPECT_EQ(ftp.download("notes.txt"), content);
    EXPECT_THAT(ftp.list("/"), Contains("Fnotes.txt\t1000"));
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_CALCFILECRC, "/notes.txt").value(), wire::crc32(0, content));
    FtpClient other(rig, {LinkId{1}, {SystemId{245}, ComponentId{190}}});
    EXPECT_EQ(other.download("/notes.txt"), content) << "files belong to the vehicle";
    ftp.upload("/notes.txt", {1, 2});
    EXPECT_THAT(ftp.download("/notes.txt"), ElementsAre(1, 2)) << "CreateFile empties";
}

TEST_F(FileService, ChecksumIsTheOneOfTheFtpSpecification) {
    // CRC-32 without inversions of "123456789": pymavlink's mavutil.x25crc is another; this is Python's
    // zlib.wire::crc32(b"123456789", 0xffffffff) ^ 0xffffffff.
    ftp.upload("/digits", bytes_of("123456789"));

    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_CALCFILECRC, "/digits").value(), 0x2dfd2d88u);
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_CALCFILECRC, "/nowhere").error(), MAV_FTP_ERR_FILENOTFOUND);
}

// A burst of 1 MB and 500 kB a second. A client that repeats its request gets the answer.
TEST_F(FileService, LimitsHowManyBytesItSumsUp) {
    constexpr std::size_t length = 250'000;
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_CREATEFILE, "/big").is_ack());
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_WRITEFILE, bytes_of("x"), 0, length - 1).is_ack());
    const auto answers_to = [&](int requests) {
        const std::size_t before = ftp.replies().size();
        for (int i = 0; i < requests; ++i) ftp.send(MAV_FTP_OPCODE_CALCFILECRC, bytes_of("/big"));
        return ftp.replies().size() - before;
    };
    EXPECT_EQ(answers_to(100), 4u);
    rig.run(1.0);
    EXPECT_EQ(answers_to(100), 2u);
    rig.run(1.0);

    --ftp.seq;
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_CALCFILECRC, "/big").is_ack());
}

TEST_F(FileService, WritesIntoAnExistingFileAndFillsGapsWithZeros) {
    ftp.upload("/f", {1, 2, 3});
    ASSERT_EQ(ftp.ask(MAV_FTP_OPCODE_OPENFILEWO, "/f", 5).value(), 3u);
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_WRITEFILE, Bytes{9}, 5, 1).is_ack());
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_WRITEFILE, Bytes{8}, 5, 5).is_ack());

    EXPECT_THAT(ftp.download("/f"), ElementsAre(1, 9, 3, 0, 0, 8));
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_TRUNCATEFILE, "/f", 0, 2).is_ack());
    EXPECT_THAT(ftp.download("/f"), ElementsAre(1, 9));
}

TEST_F(FileService, MakesRenamesAndRemovesFilesAndDirectories) {
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_CREATEFILE, "/d/f").error(), MAV_FTP_ERR_FILENOTFOUND) << "no such directory";
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_CREATEDIRECTORY, "/d").is_ack());
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_CREATEDIRECTORY, "/d").error(), MAV_FTP_ERR_FILEEXISTS);
    ftp.upload("/d/f", {1});
    const FtpReply full = ftp.ask(MAV_FTP_OPCODE_REMOVEDIRECTORY, "/d");
    EXPECT_EQ(full.error(), MAV_FTP_ERR_FAILERRNO);
    EXPECT_EQ(full.number(), ENOTEMPTY);

    auto names = bytes_of("/d");
    names.push_back(0);
    for (const char c : std::string_view("/e")) names.push_back(static_cast<std::uint8_t>(c));
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_RENAME, names).is_ack());
    EXPECT_THAT(ftp.list("/e"), ElementsAre("Ff\t1"));
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_RENAME, names).error(), MAV_FTP_ERR_FILENOTFOUND);
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_REMOVEFILE, "/e/f").is_ack());
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_REMOVEDIRECTORY, "/e").is_ack());
    EXPECT_THAT(ftp.list("/"), ElementsAre("Detc", "Dlog"));
}

TEST_F(FileService, ProtectsItsOwnFiles) {
    const std::string log = "/log/2026-11-21/" + ftp.list("/log/2026-11-21").at(0).substr(1, 12);
    for (const std::string& path :
         {std::string("/etc/extras/actuators.json.xz"), std::string("/etc/new"), log, std::string("/log/new"),
          std::string("@MAV_LOG/new"), std::string("@PARAM/param.pck")}) {
        EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_CREATEFILE, path).error(), MAV_FTP_ERR_FILEPROTECTED) << path;
        EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_OPENFILEWO, path).error(), MAV_FTP_ERR_FILEPROTECTED) << path;
        EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_REMOVEFILE, path).error(), MAV_FTP_ERR_FILEPROTECTED) << path;
        EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_TRUNCATEFILE, path).error(), MAV_FTP_ERR_FILEPROTECTED) << path;
    }
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_REMOVEDIRECTORY, "/etc").error(), MAV_FTP_ERR_FILEPROTECTED);
}

TEST_F(FileService, RefusesMoreBytesThanItStores) {
    VehicleOptions options = options_of(Autopilot::px4);
    options.limits.file_bytes = 500;
    options.limits.files = 3;
    Rig small(options);
    FtpClient client(small);
    client.upload("/a", Bytes(239));
    client.upload("/b", Bytes(239));
    ASSERT_TRUE(client.ask(MAV_FTP_OPCODE_CREATEFILE, "/c").is_ack());

    for (const std::uint32_t offset : {0u, 500u, 0xffffffffu}) {
        const FtpReply reply = client.ask(MAV_FTP_OPCODE_WRITEFILE, Bytes(100), 0, offset);
        EXPECT_EQ(reply.error(), MAV_FTP_ERR_FAILERRNO) << offset;
        EXPECT_EQ(reply.number(), ENOSPC);
    }
    EXPECT_EQ(client.ask(MAV_FTP_OPCODE_TRUNCATEFILE, "/c", 0, 1'000'000).number(), ENOSPC);
    EXPECT_EQ(client.ask(MAV_FTP_OPCODE_CREATEFILE, "/d").number(), ENOSPC);
    EXPECT_TRUE(client.ask(MAV_FTP_OPCODE_REMOVEFILE, "/a").is_ack());
    EXPECT_TRUE(client.ask(MAV_FTP_OPCODE_WRITEFILE, Bytes(100)).is_ack()) << "/c has room again";
}

TEST_F(FileService, AFileThatWasRemovedEnds) {
    ftp.upload("/f", Bytes(100));
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_OPENFILEWO, "/f", 7).is_ack());
    ASSERT_TRUE(ftp.ask(MAV_FTP_OPCODE_REMOVEFILE, "/f").is_ack());

    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_WRITEFILE, Bytes{1}, 7).error(), MAV_FTP_ERR_FILENOTFOUND);
    EXPECT_EQ(ftp.ask(MAV_FTP_OPCODE_READFILE, Bytes{}, 7, 0, 10).error(), MAV_FTP_ERR_EOF);
}

// --- Special files

TEST_F(FileService, LogsAreUnderMavLogToo) {
    EXPECT_EQ(ftp.list("@MAV_LOG"), ftp.list("/log"));
    const std::string name = ftp.list("@MAV_LOG/2026-11-21").at(0).substr(1, 12);
    EXPECT_THAT(ftp.download("@MAV_LOG/2026-11-21/" + name), testing::SizeIs(testing::Ge(20'000u)));
}

TEST(FileServiceOfArduPilot, PacksItsParametersIntoOneFile) {
    Rig rig(options_of(Autopilot::ardupilot));
    FtpClient ftp(rig);
    ASSERT_TRUE(rig.vehicle.set_parameter("SYSID_THISMAV", 1));

    const Bytes plain = ftp.download("@PARAM/param.pck");
    const Bytes with_defaults = ftp.download("@PARAM/param.pck?withdefaults=1");

    EXPECT_EQ(load_le<std::uint16_t>(plain.data()), 0x671b);
    EXPECT_EQ(load_le<std::uint16_t>(with_defaults.data()), 0x671c);
    // The reading rules of MAVProxy and QGroundControl.
    const auto total = load_le<std::uint16_t>(plain.data() + 4);
    EXPECT_EQ(load_le<std::uint16_t>(plain.data() + 2), total);
    std::map<std::string, double> values;
    std::string name;
    for (std::size_t at = 6; at < plain.size();) {
        constexpr std::array<std::size_t, 5> lengths{0, 1, 2, 4, 4};
        const std::uint8_t type = plain[at] & 0xf, common = plain[at + 1] & 0xf, rest = (plain[at + 1] >> 4) + 1;
        ASSERT_GE(type, 1);
        ASSERT_LE(type, 4);
        name = name.substr(0, common) + std::string(plain.begin() + static_cast<std::ptrdiff_t>(at) + 2,
                                                    plain.begin() + static_cast<std::ptrdiff_t>(at) + 2 + rest);
        const std::uint8_t* const value = plain.data() + at + 2 + rest;
        values[name] = type == 1   ? load_le<std::int8_t>(value)
                       : type == 2 ? load_le<std::int16_t>(value)
                       : type == 3 ? load_le<std::int32_t>(value)
                                   : double{load_le<float>(value)};
        at += 2u + rest + lengths[type];
    }
    EXPECT_EQ(values.size(), total);
    ASSERT_TRUE(values.contains("SYSID_THISMAV"));
    EXPECT_EQ(values["SYSID_THISMAV"], 1);
    EXPECT_TRUE(values.contains("FRAME_CLASS"));
    EXPECT_THAT(ftp.list("/"), ElementsAre("DAPM"));
    EXPECT_THAT(ftp.list("@MAV_LOG"),
                ElementsAre(testing::StartsWith("F00000001.BIN"), testing::StartsWith("F00000002.BIN")));
    EXPECT_TRUE(ftp.ask(MAV_FTP_OPCODE_TERMINATESESSION, Bytes{}, 9).is_ack()) << "ArduPilot acknowledges it anyway";
}

}  // namespace
}  // namespace mavloom::sim::file_tests
