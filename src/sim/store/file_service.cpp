// SPDX-License-Identifier: MIT
#include "sim/store/file_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "mavloom/msg/enums/mav_ftp_err.hpp"
#include "mavloom/msg/enums/mav_ftp_opcode.hpp"
#include "mavloom/msg/file_transfer_protocol.hpp"
#include "mavloom/wire/crc32.hpp"
#include "sim/service/shares.hpp"
#include "sim/store/log_service.hpp"
#include "sim/store/parameter_pack.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

constexpr std::array file_ids{FileTransferProtocol::id};
constexpr Nanoseconds session_idle = std::chrono::seconds{10};
// A request that comes again within this time is a repetition; later, a new one that looks alike.
constexpr Nanoseconds repeat_window = std::chrono::seconds{2};
// PX4's numbers: what it sends at once, and how many replies make a burst.
constexpr unsigned pieces_at_once = 56, pieces_of_burst = 168;
// One small request may make every vehicle of a fleet sum up a file. So each does 500 kB a second, and 1 MB at once.
constexpr Nanoseconds checksum_time_per_byte = std::chrono::microseconds{2};
constexpr Nanoseconds max_checksum_time = std::chrono::seconds{2};

}  // namespace

FileService::FileService(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
                         Radio& radio, const RecordedLogs& logs)
    : options_(options),
      firmware_(firmware),
      parameters_(parameters),
      radio_(radio),
      logs_(logs),
      tree_(firmware, logs, options.limits) {}

std::span<const MessageId> FileService::handled() const noexcept { return file_ids; }

std::string_view FileService::Request::text() const noexcept {
    const std::string_view all(reinterpret_cast<const char*>(data.data()), data.size());
    return all.substr(0, all.find('\0'));
}

void FileService::Reply::put(std::uint32_t value) noexcept {
    store_le(data.data(), value);
    size = sizeof value;
}

void FileService::receive(const Client& from, MessageId /*id*/, ByteView payload, Moment now) {
    const auto message = FileTransferProtocol::decode(payload);
    const std::uint8_t* const at = message.payload.data();
    Request request{.header = {.seq = load_le<std::uint16_t>(at),
                               .session = at[2],
                               .opcode = at[3],
                               .size = at[4],
                               .offset = load_le<std::uint32_t>(at + 8)},
                    .data = ByteView(message.payload).subspan(header_length),
                    .now = now};
    request.data = request.data.first(std::min<std::size_t>(request.header.size, data_length));
    // Replies of other vehicles, which are not for us; to answer them could go round in circles.
    if (request.header.opcode == MAV_FTP_OPCODE_ACK || request.header.opcode == MAV_FTP_OPCODE_NAK) return;
    Peer* const peer = find_peer(from, now);
    if (peer == nullptr) {
        Peer stranger{.client = from};
        return send(stranger, request.header, {.error = {MAV_FTP_ERR_NOSESSIONSAVAILABLE}});
    }
    const std::uint32_t identity = wire::crc32(0, message.payload);
    const bool repeats = peer->answered == identity && now.real - peer->used < repeat_window;
    peer->used = now.real;
    if (!repeats) {
        peer->answered = identity;
        answer(*peer, request);
    } else if (request.header.opcode != MAV_FTP_OPCODE_BURSTREADFILE) {
        radio_.send(from.link, FileTransferProtocol{.target_system = from.id.system.value,
                                                    .target_component = from.id.component.value,
                                                    .payload = peer->reply});
    } else if (peer->burst.left == 0) {
        answer(*peer, request);
    }
}

void FileService::answer(Peer& peer, const Request& request) {
    Reply reply;
    if (request.header.size > data_length) {
        reply.error = {MAV_FTP_ERR_INVALIDDATASIZE};
    } else if (!carry_out(peer, request, reply)) {
        return;
    }
    send(peer, request.header, reply);
}

bool FileService::carry_out(Peer& peer, const Request& request, Reply& reply) {
    switch (request.header.opcode) {
        case MAV_FTP_OPCODE_NONE: break;
        case MAV_FTP_OPCODE_TERMINATESESSION: end_session(peer, request, reply); break;
        case MAV_FTP_OPCODE_RESETSESSION:
            peer.sessions.clear();
            peer.burst = {};
            break;
        case MAV_FTP_OPCODE_LISTDIRECTORY: list(request, reply, false); break;
        case MAV_FTP_OPCODE_LISTDIRECTORYWITHTIME: list(request, reply, true); break;
        case MAV_FTP_OPCODE_OPENFILERO: open_for_reading(peer, request, reply); break;
        case MAV_FTP_OPCODE_CREATEFILE: open_for_writing(peer, request, reply, true, true); break;
        case MAV_FTP_OPCODE_OPENFILEWO: open_for_writing(peer, request, reply, true, false); break;
        case MAV_FTP_OPCODE_READFILE: read(peer, request, reply); break;
        case MAV_FTP_OPCODE_BURSTREADFILE:
            begin_burst(peer, request, reply);
            if (!reply.error.is_error()) send_pieces(peer, request.now);
            return reply.error.is_error();
        case MAV_FTP_OPCODE_WRITEFILE: write(peer, request, reply); break;
        case MAV_FTP_OPCODE_REMOVEFILE: change(request, reply, &FileTree::remove); break;
        case MAV_FTP_OPCODE_CREATEDIRECTORY: change(request, reply, &FileTree::make_directory); break;
        case MAV_FTP_OPCODE_REMOVEDIRECTORY: change(request, reply, &FileTree::remove_directory); break;
        case MAV_FTP_OPCODE_TRUNCATEFILE:
            change(request, reply,
                   [&](FileTree& tree, const std::string& path) { return tree.truncate(path, request.header.offset); });
            break;
        case MAV_FTP_OPCODE_RENAME: rename(request, reply); break;
        case MAV_FTP_OPCODE_CALCFILECRC:
            if (checksum(request, reply)) break;
            peer.answered.reset();  // a repetition is carried out
            return false;
        default: reply.error = {MAV_FTP_ERR_UNKNOWNCOMMAND};
    }
    return true;
}

template <class Operation>
void FileService::change(const Request& request, Reply& reply, const Operation& operation) {
    const auto path = path_of(request.text());
    reply.error = path ? std::invoke(operation, tree_, *path) : path.error();
}

FileResult<std::string> FileService::path_of(std::string_view text) const {
    auto path = normal_path(text, logs_);
    if (!path) return tl::unexpected(FileError{MAV_FTP_ERR_FILEPROTECTED});
    return *std::move(path);
}

// ArduPilot acknowledges the end of a session that is not open.
void FileService::end_session(Peer& peer, const Request& request, Reply& reply) {
    const std::uint8_t number = request.header.session;
    if (peer.burst.session == number) peer.burst = {};
    const auto ended = std::erase_if(peer.sessions, [&](const Session& session) { return session.number == number; });
    if (ended == 0 && firmware_.is_px4()) reply.error = {MAV_FTP_ERR_INVALIDSESSION};
}

// Entries from number `offset` on, as many as fit, each with a NUL at its end.
void FileService::list(const Request& request, Reply& reply, bool with_time) {
    const auto path = path_of(request.text());
    const auto entries = path ? tree_.list(*path) : tl::unexpected(path.error());
    if (!entries) {
        reply.error = entries.error();
        return;
    }
    for (std::size_t i = request.header.offset; i < entries->size(); ++i) {
        const DirectoryEntry& entry = (*entries)[i];
        std::string line = (entry.is_directory ? 'D' : 'F') + entry.name;
        if (!entry.is_directory || with_time) line += fmt::format("\t{}", entry.size);
        if (with_time) line += fmt::format("\t{}", entry.modified);
        if (reply.size + line.size() + 1 > reply.data.size()) break;
        std::memcpy(reply.data.data() + reply.size, line.c_str(), line.size() + 1);
        reply.size = static_cast<std::uint8_t>(reply.size + line.size() + 1);
    }
    if (reply.size == 0) reply.error = {MAV_FTP_ERR_EOF};
}

void FileService::open_for_reading(Peer& peer, const Request& request, Reply& reply) {
    const auto path = path_of(request.text());
    auto made = path && !firmware_.is_px4() ? parameter_pack(parameters_, *path) : std::nullopt;
    const auto file = !path ? tl::unexpected(path.error()) : made ? FileResult<FileRef>{FileRef{}} : tree_.find(*path);
    if (!file) {
        reply.error = file.error();
        return;
    }
    Session* const session = open_session(peer, request);
    if (session == nullptr) {
        reply.error = {MAV_FTP_ERR_NOSESSIONSAVAILABLE};
        return;
    }
    *session = {.number = request.header.session, .file = *file, .made = std::move(made), .used = request.now.real};
    reply.put(session->made ? static_cast<std::uint32_t>(session->made->size()) : tree_.size(*file).value_or(0));
}

void FileService::open_for_writing(Peer& peer, const Request& request, Reply& reply, bool may_make, bool empties) {
    const bool is_full = find_session(peer, request.header.session) == nullptr &&
                         peer.sessions.size() >= options_.limits.file_sessions;
    const auto path = path_of(request.text());
    if (!path || is_full) {
        reply.error = path ? FileError{MAV_FTP_ERR_NOSESSIONSAVAILABLE} : path.error();
        return;
    }
    const auto file = tree_.open_for_writing(*path, may_make, empties, options_.utc_at_start + request.now.flight);
    if (!file) {
        reply.error = file.error();
        return;
    }
    *open_session(peer, request) = {
        .number = request.header.session, .file = *file, .is_writable = true, .used = request.now.real};
    reply.put(tree_.size(*file).value_or(0));
}

void FileService::read(Peer& peer, const Request& request, Reply& reply) {
    Session* const session = find_session(peer, request.header.session);
    if (session == nullptr) {
        reply.error = {MAV_FTP_ERR_INVALIDSESSION};
        return;
    }
    session->used = request.now.real;
    const ByteSpan out = ByteSpan(reply.data).first(request.header.size);
    reply.size = static_cast<std::uint8_t>(read_session(*session, request.header.offset, out));
    if (reply.size == 0) reply.error = {MAV_FTP_ERR_EOF};
}

std::size_t FileService::read_session(const Session& session, std::uint32_t offset, ByteSpan out) const {
    if (!session.made) return tree_.read(session.file, offset, out);
    const ByteView content = *session.made;
    if (offset >= content.size()) return 0;
    const std::size_t length = std::min(out.size(), content.size() - offset);
    std::memcpy(out.data(), content.data() + offset, length);
    return length;
}

void FileService::write(Peer& peer, const Request& request, Reply& reply) {
    Session* const session = find_session(peer, request.header.session);
    if (session == nullptr || !session->is_writable) {
        reply.error = {MAV_FTP_ERR_INVALIDSESSION};
        return;
    }
    session->used = request.now.real;
    reply.error = tree_.write(session->file, request.header.offset, request.data);
    reply.put(request.header.size);
}

void FileService::rename(const Request& request, Reply& reply) {
    const std::string_view from = request.text();
    const ByteView rest = request.data.subspan(std::min(request.data.size(), from.size() + 1));
    const auto old_path = path_of(from), new_path = path_of(Request{.data = rest}.text());
    if (!old_path || !new_path) {
        reply.error = {MAV_FTP_ERR_FILEPROTECTED};
        return;
    }
    reply.error = tree_.rename(*old_path, *new_path);
}

bool FileService::checksum(const Request& request, Reply& reply) {
    const auto path = path_of(request.text());
    const auto file = path ? tree_.find(*path) : tl::unexpected(path.error());
    if (!file) {
        reply.error = file.error();
        return true;
    }
    checksums_until_ = std::max(checksums_until_, request.now.real);
    if (checksums_until_ - request.now.real >= max_checksum_time) return false;
    checksums_until_ += checksum_time_per_byte * tree_.size(*file).value_or(0);
    reply.put(tree_.checksum(*file));
    return true;
}

// --- Burst

void FileService::begin_burst(Peer& peer, const Request& request, Reply& reply) {
    Session* const session = find_session(peer, request.header.session);
    if (session == nullptr) {
        reply.error = {MAV_FTP_ERR_INVALIDSESSION};
        return;
    }
    session->used = request.now.real;
    peer.burst = {.session = session->number,
                  .size = request.header.size == 0 ? static_cast<std::uint8_t>(data_length) : request.header.size,
                  .seq = static_cast<std::uint16_t>(request.header.seq + 1),
                  .offset = request.header.offset,
                  .left = pieces_of_burst};
}

bool FileService::send_piece(Peer& peer) {
    Burst& burst = peer.burst;
    if (burst.left == 0 || !radio_.has_room(peer.client.link)) return false;
    const Session* const session = find_session(peer, burst.session);
    Header header{.seq = static_cast<std::uint16_t>(burst.seq - 1),
                  .session = burst.session,
                  .opcode = MAV_FTP_OPCODE_BURSTREADFILE,
                  .offset = burst.offset};
    Reply reply;
    if (session != nullptr)
        reply.size = static_cast<std::uint8_t>(
            read_session(*session, burst.offset, ByteSpan(reply.data).first(burst.size)));
    if (reply.size == 0) {
        reply.error = {session == nullptr ? std::uint8_t{MAV_FTP_ERR_INVALIDSESSION} : std::uint8_t{MAV_FTP_ERR_EOF}};
        burst.left = 0;
    } else {
        --burst.left;
        header.burst_complete = burst.left == 0;
    }
    ++burst.seq;
    burst.offset += reply.size;
    send(peer, header, reply);
    return true;
}

void FileService::send_pieces(Peer& peer, Moment now) {
    for (unsigned i = 0; i < pieces_at_once && send_piece(peer); ++i)
        if (Session* const session = find_session(peer, peer.burst.session)) session->used = now.real;
}

void FileService::send(Peer& peer, const Header& header, const Reply& reply) {
    FileTransferProtocol message{.target_system = peer.client.id.system.value,
                                 .target_component = peer.client.id.component.value};
    std::uint8_t* const at = message.payload.data();
    store_le(at, static_cast<std::uint16_t>(header.seq + 1));
    at[2] = header.session;
    at[3] = reply.error.is_error() ? MAV_FTP_OPCODE_NAK : MAV_FTP_OPCODE_ACK;
    at[5] = header.opcode;
    at[6] = header.burst_complete ? 1 : 0;
    store_le(at + 8, header.offset);
    if (!reply.error.is_error()) {
        at[4] = reply.size;
        std::memcpy(at + header_length, reply.data.data(), reply.size);
    } else {
        const bool has_number = reply.error.code == MAV_FTP_ERR_FAILERRNO;
        at[4] = has_number ? 2 : 1;
        at[header_length] = reply.error.code;
        if (has_number) at[header_length + 1] = reply.error.number;
    }
    peer.reply = message.payload;
    radio_.send(peer.client.link, message);
}

// --- Clients and sessions

FileService::Peer* FileService::find_peer(const Client& client, Moment now) {
    const auto at = std::ranges::find(peers_, client, &Peer::client);
    if (at != peers_.end()) return &*at;
    const std::size_t most = options_.limits.clients;
    // A client without a session that has been silent has nothing to lose but the answer to a repetition.
    if (peers_.size() >= most)
        std::erase_if(peers_, [&](const Peer& p) { return p.sessions.empty() && now.real - p.used >= session_idle; });
    if (!make_room(peers_, client.link, most)) return nullptr;
    return &peers_.emplace_back(Peer{.client = client});
}

FileService::Session* FileService::find_session(Peer& peer, std::uint8_t number) noexcept {
    const auto at = std::ranges::find(peer.sessions, number, &Session::number);
    return at == peer.sessions.end() ? nullptr : &*at;
}

// A client that opens a session again, perhaps after it restarted, gives up the old one.
FileService::Session* FileService::open_session(Peer& peer, const Request& request) const {
    if (Session* const old = find_session(peer, request.header.session)) {
        if (peer.burst.session == old->number) peer.burst = {};
        return old;
    }
    if (peer.sessions.size() >= options_.limits.file_sessions) return nullptr;
    return &peer.sessions.emplace_back();
}

bool FileService::is_busy() const noexcept {
    return std::ranges::any_of(peers_, [](const Peer& peer) { return !peer.sessions.empty() || peer.burst.left != 0; });
}

void FileService::pump(Moment now) {
    for (Peer& peer : peers_) {
        send_pieces(peer, now);
        std::erase_if(peer.sessions, [&](const Session& session) { return now.real - session.used >= session_idle; });
    }
}

void FileService::forget(LinkId link) {
    std::erase_if(peers_, [&](const Peer& peer) { return peer.client.link == link; });
}

}  // namespace mavloom::sim
