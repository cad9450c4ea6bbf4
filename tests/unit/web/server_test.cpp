// SPDX-License-Identifier: MIT
// The threads of a server: one that receives, that of its clients, and those of two clients.
#include "mavloom/web/server.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>

#include "mavloom/http/client.hpp"
#include "support/eventually.hpp"
#include "support/golden_frames.hpp"
#include "unit/feed/fixture.hpp"

namespace mavloom::web {
namespace {

using feed::testing::view;
using test::eventually;

const net::Address any_port = *net::Address::parse("127.0.0.1", 0);

// Subscribes to the first channel, and to three reports.
class Viewer {
public:
    Viewer(const http::Thread& thread, const net::Address& server)
        : client_(http::Client::connect(
              thread, {.addresses = {server}, .host = "localhost", .session = {.accepts = http::Accepts::both}},
              {.on_open = [this](const auto& session) { return take(session); }, .on_failed = [](const auto&) {}})) {}

    std::atomic<int> messages = 0;

private:
    http::SessionEvents take(const std::shared_ptr<http::Session>& session) {
        static constexpr std::string_view request =
            R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1},)"
            R"({"id":2,"channelId":1000000001},{"id":3,"channelId":1000000002},{"id":4,"channelId":1000000003}]})";
        return {.on_message = [this, session](ByteView bytes, http::Kind kind) {
            const std::string text(bytes.begin(), bytes.end());
            if (kind == http::Kind::binary) ++messages;
            if (kind == http::Kind::text && text.find(R"("id":1,)") != std::string::npos) {
                session->push({reinterpret_cast<const std::uint8_t*>(request.data()), request.size()}, 0, 0, mono_now(),
                              http::Kind::text);
                session->flush();
            }
            return true;
        }};
    }

    http::Client client_;
};

TEST(WebServer, SendsFramesToAllClientsWhileTheyComeAndGo) {
    auto server = *Server::listen(dialect::default_dialect(), {.addresses = {any_port}});
    const auto thread = *http::Thread::start();
    const auto take = [&] {
        server->take({.frame = view(test::attitude_v2), .time = wall_now(), .now = mono_now()});
        server->flush();
    };
    std::atomic<bool> ends = false;
    std::thread owner([&] {
        for (std::uint64_t frames = 0; !ends; ++frames) {
            server->note_counts({.frames = frames,
                                 .on_links = {{.source = {SystemId{1}, ComponentId{1}}, .received = frames}},
                                 .losses = {{"crc_error", frames}}});
            server->set_hops({{.name = "router", .frames_in = frames}});
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    });
    Viewer stays(thread, server->addresses().front());
    for (int i = 0; i < 5; ++i) {
        Viewer leaves(thread, server->addresses().front());
        EXPECT_TRUE(eventually([&] {
            take();
            return leaves.messages > 3 && stays.messages > 3;
        }));
    }
    ends = true;
    owner.join();
}

TEST(WebServer, RefusesAPortInUse) {
    const auto first = *Server::listen(dialect::default_dialect(), {.addresses = {any_port}});
    const auto second = Server::listen(dialect::default_dialect(), {.addresses = first->addresses()});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, SetupCode::in_use);
}

}  // namespace
}  // namespace mavloom::web
