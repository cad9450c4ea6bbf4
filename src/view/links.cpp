// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "view/table.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

constexpr std::array kinds{"source", "router", "simulator", "listener", "relay", "page"};
constexpr std::array<int, 6> link_ends{44, 52, 60, 69, 78, 85};
constexpr std::array<std::string_view, 6> titles{"LINK", "HZ IN", "HZ OUT", "IN", "OUT", "QUEUE"};

constexpr int of_program = 3, of_link = 5;  // where lines begin that stand below a program or a link

// A program, a link of it, frames that either of them lost, or a note about it.
struct LinkLine {
    const observe::Hop* hop = nullptr;
    const observe::HopLink* link = nullptr;
    const observe::NamedCount* loss = nullptr;
    std::string note{};
};

void add_losses(std::vector<LinkLine>& lines, const observe::Hop& hop, const observe::HopLink* link,
                const std::vector<observe::NamedCount>& losses) {
    for (const auto& loss : losses)
        if (loss.count != 0) lines.push_back({&hop, link, &loss});
}

// Breaks the hint of a program at blanks.
void add_hint(std::vector<LinkLine>& lines, const observe::Hop& hop, int width) {
    for (std::string_view rest = hop.hint; !rest.empty();)
        lines.push_back({.hop = &hop, .note = std::string(take_words(rest, width - of_program))});
}

void add_refused(std::vector<LinkLine>& lines, const observe::Hop& hop, const observe::HopLink& link) {
    if (link.refused == 0) return;
    lines.push_back({.hop = &hop,
                     .link = &link,
                     .note = fmt::format("{} refused: no program listened at its port, or its host was gone",
                                         count_text(link.refused))});
}

std::vector<LinkLine> lines_of_hops(const std::vector<observe::Hop>& hops, int width) {
    std::vector<LinkLine> lines;
    for (const auto& hop : hops) {
        lines.push_back({&hop});
        add_hint(lines, hop, width);
        add_losses(lines, hop, nullptr, hop.losses);
        for (const auto& link : hop.links) {
            lines.push_back({&hop, &link});
            add_losses(lines, hop, &link, link.losses);
            add_refused(lines, hop, link);
        }
    }
    return lines;
}

class LinkTable : public Table {
public:
    LinkTable(const Snapshot& shown, int width) : lines_(lines_of_hops(shown.hops, width)) {}

    [[nodiscard]] int size() const override { return static_cast<int>(lines_.size()); }
    void draw_head(Grid& grid, int y) const override {
        grid.put(1, y, titles.front(), Ink::strong);
        for (std::size_t i = 1; i < link_ends.size(); ++i) grid.put_right(place(grid, i), y, titles[i], Ink::strong);
    }
    void draw_line(Grid& grid, int y, int line) const override {
        const auto& its = lines_[static_cast<std::size_t>(line)];
        if (its.loss != nullptr) return draw_loss(grid, y, its);
        if (!its.note.empty())
            return void(grid.put(its.link == nullptr ? of_program : of_link, y, its.note, Ink::warning));
        if (its.link != nullptr) return draw_flow(grid, y, 3, its.link->name, *its.link, Ink::plain);
        const auto kind = kinds[static_cast<std::size_t>(its.hop->kind)];
        draw_flow(grid, y, 1, fmt::format("{} {}", kind, its.hop->name), *its.hop, Ink::accent);
    }

private:
    // Narrow terminals have less room for the names.
    static int place(const Grid& grid, std::size_t column) {
        return link_ends[column] - std::clamp(link_ends.back() + 1 - grid.size().width, 0, 24);
    }

    static void draw_loss(Grid& grid, int y, const LinkLine& its) {
        const int x = its.link == nullptr ? of_program : of_link;
        const auto end = grid.put(x, y, fmt::format("{} {}", count_text(its.loss->count), its.loss->name), Ink::bad);
        grid.put(end, y, its.loss->help.empty() ? "" : ": " + its.loss->help, Ink::dim);
    }

    static bool has_ended(const observe::Hop& /*hop*/) { return false; }
    static bool has_ended(const observe::HopLink& link) { return link.has_ended; }

    template <class Flow>
    static void draw_flow(Grid& grid, int y, int x, std::string_view name, const Flow& its, Ink ink) {
        grid.put(x, y, name, its.is_up ? ink : Ink::dim, place(grid, 0) - 1);
        if (has_ended(its)) return grid.put_right(place(grid, 1), y, "ended", Ink::dim);
        if (!its.is_up) return grid.put_right(place(grid, 1), y, "down", Ink::bad);
        const auto rate = [](const std::optional<double>& hz) { return hz ? hz_text(*hz) : "-"; };
        const std::array texts{rate(its.hz_in), rate(its.hz_out), count_text(its.frames_in), count_text(its.frames_out)};
        for (std::size_t i = 0; i < texts.size(); ++i) grid.put_right(place(grid, i + 1), y, texts[i], Ink::plain);
        if (const auto fill = fill_of(its)) draw_fill(grid, y, *fill);
    }

    // How full the queue is, 0 to 1.
    static std::optional<double> fill_of(const observe::Hop& /*hop*/) { return std::nullopt; }
    static std::optional<double> fill_of(const observe::HopLink& link) {
        if (link.queue_limit_bytes == 0) return std::nullopt;
        return static_cast<double>(link.queued_bytes) / static_cast<double>(link.queue_limit_bytes);
    }
    static void draw_fill(Grid& grid, int y, double fill) {
        constexpr double much = 0.25, nearly_full = 0.75;
        const auto ink = fill >= nearly_full ? Ink::bad : fill >= much ? Ink::warning : Ink::plain;
        grid.put_right(place(grid, link_ends.size() - 1), y, fmt::format("{:.0f} %", std::ceil(100 * fill)), ink);
    }

    const std::vector<LinkLine> lines_;
};

}  // namespace

std::unique_ptr<Table> link_table(const Snapshot& shown, int width) {
    return std::make_unique<LinkTable>(shown, width);
}

}  // namespace mavloom::view
