// SPDX-License-Identifier: MIT
// The mission protocol: upload and download of missions, fences and rally points. Private to module sim; single owner.
// Source: MAVLink guide, "Mission Protocol".
//
// A transfer belongs to a client and a type of plan. One client at a time may upload a type. Its items are buffered and
// replace the plan only at the end. While an upload waits for an item, the service repeats its request every 250 ms (as
// ArduPilot: every second). If the client sends nothing for 5 s (8 s), the service gives up, and the old plan stays. A
// client may download items in any order and need not send the final MISSION_ACK.
#pragma once

#include <optional>
#include <vector>

#include "flight/flight.hpp"
#include "flight/plan.hpp"
#include "mavloom/msg/mission_count.hpp"
#include "sim/radio/radio.hpp"
#include "sim/service/service.hpp"
#include "sim/service/text_limit.hpp"

namespace mavloom::sim {

class PlanService final : public Service {
public:
    PlanService(const Firmware& firmware, Flight& flight, Radio& radio, FlightObserver& observer, const Limits& limits,
                const FlightTime& stepped) noexcept
        : firmware_(firmware), flight_(flight), radio_(radio), observer_(observer), limits_(limits), stepped_(stepped) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;
    [[nodiscard]] bool is_busy() const noexcept override { return !transfers_.empty(); }
    [[nodiscard]] FlightTime wakes_at() const noexcept override;
    void pump(Moment now) override;
    void reboot() override;
    void forget(LinkId link) override;

    // Sends MISSION_ITEM_REACHED to all links. PX4 repeats it ten times, once a second.
    void report_reached(std::uint16_t seq);

private:
    enum class Stage : std::uint8_t {
        upload,
        download,
        finished,  // an upload that is complete; kept to acknowledge its last item again
    };
    struct Transfer {
        Client client;
        PlanType type;
        Stage stage;
        bool asks_int = true;                    // upload: by MISSION_REQUEST_INT; false: by MISSION_REQUEST
        bool has_form = false;                   // upload: an item has shown which form the client speaks
        bool was_refused = false;                // upload: the client has refused a form
        bool was_asked = false;                  // download: a request has arrived, so MISSION_COUNT is not repeated
        unsigned repeats = 0;                    // upload: of the request, until an item arrives
        std::uint16_t next = 0, end = 0;         // upload: the item that is awaited, and one past the last one
        std::uint32_t edition = 0;               // download: of the plan
        std::optional<std::uint16_t> current{};  // upload: the item that the client marked as current
        MonoTime heard{}, sent{};
        std::vector<PlanItem> items{};  // upload: the whole new plan
    };
    struct Request {  // an item as the client sent it
        PlanItem item;
        std::uint16_t seq;
        std::uint8_t current, mission_type;
        bool is_int;
    };
    struct Reached {
        std::uint16_t seq = 0;
        int repeats = 0;  // still to come
        FlightTime due{};
    };

    void on_count(const Client& from, const msg::MissionCount& message, Moment now);
    void on_partial_write(const Client& from, ByteView payload, Moment now);
    void on_item(const Client& from, const Request& request, Moment now);
    void on_list(const Client& from, std::uint8_t mission_type, Moment now);
    void on_request(const Client& from, std::uint16_t seq, std::uint8_t mission_type, bool is_int, Moment now);
    void on_ack(const Client& from, ByteView payload, Moment now);
    void on_clear(const Client& from, std::uint8_t mission_type);
    void on_set_current(std::uint16_t seq, Moment now);
    // ArduPilot: an item that is an order to fly to a point (current = 2) or to a height (3).
    void on_guided_item(const Client& from, const Request& request);

    Transfer* begin_upload(const Client& from, PlanType type, Moment now);
    void store_item(Transfer& transfer, const Request& request, Moment now);
    void finish(Transfer& transfer);
    void announce(std::string_view text);  // if there is one
    void replace(PlanType type, std::vector<PlanItem> items);
    [[nodiscard]] PlanItem stored_item(PlanType type, std::uint16_t seq) const;
    void send_item(const Client& to, PlanType type, std::uint16_t seq, bool is_int);
    [[nodiscard]] bool is_home(PlanType type, std::uint16_t seq) const noexcept;
    void ask(Transfer& transfer, Moment now);
    void ask_again(Transfer& transfer, Moment now);
    void request_item(Transfer& transfer, bool as_int, Moment now);
    void send_count(Transfer& transfer, Moment now);
    void acknowledge(const Client& to, std::uint8_t mission_type, std::uint8_t result, std::uint32_t plan_id = 0);
    // Returns false once the transfer is over.
    [[nodiscard]] bool keep_alive(Transfer& transfer, Moment now);

    [[nodiscard]] Transfer* find(const Client& client, PlanType type) noexcept;
    [[nodiscard]] bool is_uploaded_by_another(const Client& client, PlanType type) const noexcept;
    void drop(const Client& client, PlanType type) noexcept;
    [[nodiscard]] std::size_t limit(PlanType type) const noexcept;

    const Firmware& firmware_;
    Flight& flight_;
    Radio& radio_;
    FlightObserver& observer_;
    const Limits& limits_;
    const FlightTime& stepped_;
    std::vector<Transfer> transfers_;  // at most Limits::clients
    Reached reached_;
    TextLimit texts_;  // about messages that do not fit
};

}  // namespace mavloom::sim
