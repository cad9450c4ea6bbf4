// SPDX-License-Identifier: MIT
// MAVLink FTP. Private to module sim; single owner. Source: MAVLink guide, "File Transfer Protocol (FTP)".
//
// Sessions belong to a client and have the number that the client gave when it opened the file. QGroundControl takes
// the number from the reply, MAVSDK always uses 0, MAVProxy and pymavlink count their own. A request that is repeated
// byte for byte gets the same reply again, without being carried out twice. A session ends after 10 s without a
// request. Requests for too many checksums get no reply; clients repeat them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sim/service/service.hpp"
#include "sim/store/file_tree.hpp"

namespace mavloom::sim {

class FileService final : public Service {
public:
    FileService(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters, Radio& radio,
                const RecordedLogs& logs);

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;
    [[nodiscard]] bool is_busy() const noexcept override;
    void pump(Moment now) override;
    void reboot() override { peers_.clear(); }
    void forget(LinkId link) override;

private:
    static constexpr std::size_t payload_length = 251, header_length = 12, data_length = payload_length - header_length;
    using Payload = std::array<std::uint8_t, payload_length>;

    struct Header {
        std::uint16_t seq = 0;
        std::uint8_t session = 0, opcode = 0, size = 0, request_opcode = 0;
        bool burst_complete = false;
        std::uint32_t offset = 0;
    };
    // A burst read that is under way.
    struct Burst {
        std::uint8_t session = 0, size = 0;
        std::uint16_t seq = 0;  // of the next reply
        std::uint32_t offset = 0;
        unsigned left = 0;  // replies until the client has to ask again; 0: no burst runs
    };
    struct Session {
        std::uint8_t number = 0;
        FileRef file{};
        bool is_writable = false;
        std::optional<std::vector<std::uint8_t>> made{};  // the content of a file that is computed for this session
        MonoTime used{};
    };
    struct Peer {
        Client client;
        MonoTime used{};
        std::vector<Session> sessions{};  // at most Limits::file_sessions
        Burst burst{};
        // The last request and its reply, for repetitions.
        std::optional<std::uint32_t> answered{};  // checksum of the request; its sequence number is part of it
        Payload reply{};
    };
    struct Request {
        Header header{};
        ByteView data{};
        Moment now{};
        [[nodiscard]] std::string_view text() const noexcept;  // a path; ends at the first NUL
    };
    // The outcome of a request: an error, or data for an ACK.
    struct Reply {
        FileError error{};
        std::uint8_t size = 0;
        std::array<std::uint8_t, data_length> data{};

        void put(std::uint32_t value) noexcept;
    };

    void answer(Peer& peer, const Request& request);
    // Returns false if there is no single reply: a burst has begun, or too many checksums were requested.
    [[nodiscard]] bool carry_out(Peer& peer, const Request& request, Reply& reply);
    void end_session(Peer& peer, const Request& request, Reply& reply);
    void list(const Request& request, Reply& reply, bool with_time);
    void open_for_reading(Peer& peer, const Request& request, Reply& reply);
    void open_for_writing(Peer& peer, const Request& request, Reply& reply, bool may_make, bool empties);
    void read(Peer& peer, const Request& request, Reply& reply);
    void write(Peer& peer, const Request& request, Reply& reply);
    void begin_burst(Peer& peer, const Request& request, Reply& reply);
    void rename(const Request& request, Reply& reply);
    // Returns false if too many checksums were requested.
    [[nodiscard]] bool checksum(const Request& request, Reply& reply);
    // For operations on a path that answer without data.
    template <class Operation>
    void change(const Request& request, Reply& reply, const Operation& operation);

    void send(Peer& peer, const Header& header, const Reply& reply);
    // Returns false if the burst is over or the link has no room.
    [[nodiscard]] bool send_piece(Peer& peer);
    void send_pieces(Peer& peer, Moment now);
    [[nodiscard]] std::size_t read_session(const Session& session, std::uint32_t offset, ByteSpan out) const;

    // Null if there are too many clients.
    [[nodiscard]] Peer* find_peer(const Client& client, Moment now);
    [[nodiscard]] static Session* find_session(Peer& peer, std::uint8_t number) noexcept;
    // Null if the client has too many sessions open.
    [[nodiscard]] Session* open_session(Peer& peer, const Request& request) const;
    [[nodiscard]] FileResult<std::string> path_of(std::string_view text) const;

    const VehicleOptions& options_;
    const Firmware& firmware_;
    const Parameters& parameters_;
    Radio& radio_;
    const RecordedLogs& logs_;
    FileTree tree_;
    std::vector<Peer> peers_;     // at most Limits::clients
    MonoTime checksums_until_{};  // when the checksums so far would be done at the usual rate
};

}  // namespace mavloom::sim
