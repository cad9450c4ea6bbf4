// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "view/table.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

constexpr std::array severity_names{"error", "warning", "info"};
constexpr std::array severity_inks{Ink::bad, Ink::warning, Ink::plain};

enum AlarmColumn : std::uint8_t { alarm_began, alarm_lasted, alarm_severity, alarm_from, alarm_text };

// The text, the last one, gets the room that is left.
constexpr std::array<Spec, 5> alarm_specs{{{"BEGAN", 9, 2, false},
                                           {"LASTED", 9, 3, false},
                                           {"SEVERITY", 10, 4, false},
                                           {"FROM", 9, 1, false},
                                           {"ALARM", 25, 0, false}}};

class AlarmTable : public Table {
public:
    AlarmTable(const Snapshot& shown, int width) : shown_(shown), ends_(fit(alarm_specs, 1, width - 1)) {}

    [[nodiscard]] int size() const override { return static_cast<int>(shown_.alarms.size() + shown_.notices.size()); }
    void draw_head(Grid& grid, int y) const override {
        for (std::size_t i = 0; i < ends_.size(); ++i)
            put(grid, y, static_cast<AlarmColumn>(i), alarm_specs[i].title, Ink::strong);
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
        put(grid, y, alarm_began, time_text(shown_.now.wall - alarm.since), ink);
        put(grid, y, alarm_lasted, alarm.ended ? time_text(*alarm.ended - alarm.since) : "now", ink);
        put(grid, y, alarm_severity, severity_names[severity], ink);
        put(grid, y, alarm_from, alarm.source == Source{} ? alarm.link : source_text(alarm.source), ink);
        put(grid, y, alarm_text, alarm.text, ink);
    }

    void put(Grid& grid, int y, AlarmColumn column, std::string_view text, Ink ink) const {
        const auto& spec = alarm_specs[column];
        if (column == alarm_text) grid.put(ends_[column] - spec.width, y, text, ink);
        else put_in(grid, y, spec, ends_[column], text, ink);
    }

    const Snapshot& shown_;
    const std::vector<int> ends_;
};

}  // namespace

std::unique_ptr<Table> alarm_table(const Snapshot& shown, int width) {
    return std::make_unique<AlarmTable>(shown, width);
}

}  // namespace mavloom::view
