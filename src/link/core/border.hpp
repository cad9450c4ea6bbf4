// SPDX-License-Identifier: MIT
// The stages of one link (mavloom/link/stage.hpp), and what is held for them. A link without stages has no border.
// Private to module link; single owner thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "link/core/tickers.hpp"
#include "mavloom/link/stage.hpp"

namespace mavloom::link::detail {

class Core;
struct Link;

enum class Way : std::uint8_t { in, out };

class Border final : public Ticker {
public:
    Border(Core& core, Link& link) noexcept : core_(core), link_(link) {}
    Border(const Border&) = delete;
    Border& operator=(const Border&) = delete;
    ~Border() override;

    // Exchanges the stages. Pieces that the earlier ones hold pass the border before all others, without more stages.
    // `by`: what created them.
    void replace(Stages stages, const CreateStages& by);
    [[nodiscard]] const CreateStages& made_by() const noexcept { return made_by_; }
    // Stages::text.
    [[nodiscard]] const std::string& text() const noexcept { return text_; }
    // Passes the piece through the stages. Inward only during a turn.
    void take(Way way, const Piece& piece);
    // The stream or connection ends in this turn: passes on what is held.
    void release(Way way);
    // Drops what is held, and counts it.
    void drop(Way way) noexcept;
    [[nodiscard]] std::size_t held_bytes(Way way) const noexcept { return at(way).bytes; }

    [[nodiscard]] std::optional<MonoTime> tick_due() const override;
    void tick(MonoTime now) override;

private:
    class Step;
    struct Held {
        Piece piece;
        std::vector<std::uint8_t> bytes;  // of the piece
        std::size_t place;                // of the stage that takes it
    };
    struct Chain {
        std::vector<std::unique_ptr<Stage>> stages;
        std::multimap<MonoTime, Held> held;
        std::size_t bytes = 0;  // in `held`

        void exchange(std::vector<std::unique_ptr<Stage>> others);
        void keep(MonoTime when, Held piece);
        // When a held piece or a stage is due; MonoTime::max() if none is.
        [[nodiscard]] MonoTime due() const noexcept;
    };
    class Rest;

    [[nodiscard]] Chain& at(Way way) noexcept { return chains_[static_cast<std::size_t>(way)]; }
    [[nodiscard]] const Chain& at(Way way) const noexcept { return chains_[static_cast<std::size_t>(way)]; }
    // `place`: of the stage that takes the piece.
    void pass(Way way, std::size_t place, const Piece& piece, MonoTime now);
    [[nodiscard]] bool has_room(const Chain& chain, const Piece& piece) const noexcept;
    void hold(Way way, std::size_t place, const Piece& piece, MonoTime now, MonoTime when);
    void release_until(Way way, MonoTime end);
    void tick_stages(Way way, MonoTime now);
    void leave(Way way, const Piece& piece);
    [[nodiscard]] bool is_idle() const noexcept;

    Core& core_;
    Link& link_;
    std::array<Chain, 2> chains_;  // by Way
    std::string text_;
    CreateStages made_by_;
};

}  // namespace mavloom::link::detail
