// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "view/table.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

constexpr std::array severity_names{"error", "warning", "info"};
constexpr std::array severity_inks{Ink::bad, Ink::warning, Ink::plain};

class AlarmTable : public Table {
public:
    explicit AlarmTable(const Snapshot& shown) : shown_(shown) {}

    [[nodiscard]] int size() const override { return static_cast<int>(shown_.alarms.size() + shown_.notices.size()); }
    void draw_head(Grid& grid, int y) const override {
        grid.put_right(9, y, "BEGAN", Ink::strong);
        grid.put(11, y, "LASTED   SEVERITY  FROM     ALARM", Ink::strong);
    }
    void draw_line(Grid& grid, int y, int line) const override {
        const auto at = static_cast<std::size_t>(line);
        if (at < shown_.alarms.size()) return draw_alarm(grid, y, shown_.alarms[at]);
        grid.put(1, y, shown_.notices[shown_.notices.size() + shown_.alarms.size() - 1 - at], Ink::dim);
    }

private:
    void draw_alarm(Grid& grid, int y, const observe::Alarm& alarm) const {
        const auto severity = static_cast<std::size_t>(alarm.severity);
        const auto ink = alarm.ended ? Ink::dim : severity_inks[severity];
        grid.put_right(9, y, time_text(shown_.now.wall - alarm.since), ink);
        grid.put(11, y, alarm.ended ? time_text(*alarm.ended - alarm.since) : "now", ink);
        grid.put(20, y, severity_names[severity], ink);
        grid.put(30, y, alarm.source == Source{} ? alarm.link : source_text(alarm.source), ink, 38);
        grid.put(39, y, alarm.text, ink);
    }

    const Snapshot& shown_;
};

}  // namespace

std::unique_ptr<Table> alarm_table(const Snapshot& shown) { return std::make_unique<AlarmTable>(shown); }

}  // namespace mavloom::view
