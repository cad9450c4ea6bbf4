// SPDX-License-Identifier: MIT
// tcpin and tcpout: a TCP stream as a link. Private to module link; single owner thread.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "link/peer_policy.hpp"
#include "link/stream_peer.hpp"
#include "link/tcp/http_opening.hpp"
#include "mavloom/net/tcp.hpp"

namespace mavloom::link::detail {

class TcpPeer;

class TcpOwner {
public:
    virtual ~TcpOwner() = default;
    // Called when the stream has ended. The peer is detached and may be passed to Core::destroy_later.
    virtual void on_closed(TcpPeer& peer, std::string_view why) = 0;
    // Called when a client's first bytes are those of HTTP or TLS. Closes the client.
    virtual void on_http(TcpPeer&) {}
};

// A far side is never disconnected because it reads slowly.
class TcpPeer final : public StreamPeer<TcpPeer, net::TcpStream> {
public:
    TcpPeer(Core& core, TcpOwner& owner, EndpointId endpoint_id, const endpoint::EndpointOptions& options)
        : StreamPeer(core, endpoint_id, options), owner_(owner) {}

    // Delivers the events that the parser still holds back, then closes the stream and calls on_closed.
    void close(std::string_view why) {
        finish_parsing();
        drop(why);
    }
    // Like `close`, but discards the bytes that the parser holds back. For an owner that closes between turns.
    void drop(std::string_view why) {
        detach();
        owner_.on_closed(*this, why);
    }

    // Copies of frames that others have sent are no talk.
    [[nodiscard]] PeerPolicy::Candidate candidate() const noexcept {
        const bool has_talked = counters.frames_in.value() != frames_repeated;
        return {id, has_talked, has_talked ? last_heard : connected_at, crowd};
    }
    MonoTime connected_at{};
    std::uint16_t crowd = 0;  // of a client of a tcpin

    // Watches for an HTTP request or TLS at the start of the stream. Call it for the clients of a tcpin.
    void refuse_http() noexcept { opening_ = HttpOpening(); }
    [[nodiscard]] bool accepts(ByteView bytes) {
        if (!opening_) [[likely]]
            return true;
        const auto verdict = opening_->note(bytes);
        if (verdict != HttpOpening::Verdict::undecided) opening_.reset();
        if (verdict != HttpOpening::Verdict::http) return true;
        counters.junk_bytes.add(bytes.size());
        owner_.on_http(*this);
        return false;
    }
    [[nodiscard]] static bool wants(const wire::ParseEvent&) noexcept { return true; }

private:
    void on_end(net::IoError error) override {
        close(error == net::IoError::closed ? "closed by the far side" : "failed");
    }

    TcpOwner& owner_;
    std::optional<HttpOpening> opening_;
};

}  // namespace mavloom::link::detail
