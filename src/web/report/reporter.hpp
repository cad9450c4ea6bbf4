// SPDX-License-Identifier: MIT
// Makes the texts of the reports. Private to module web. One thread uses it; `set_hops` and `note_counts`
// may be called from any.
//
// `mutex` guards what another thread changes. It is held only while rows are copied, never while text is made.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mavloom/observe/inspector.hpp"
#include "mavloom/observe/own_counts.hpp"
#include "web/channels.hpp"
#include "web/report/cached_text.hpp"
#include "web/report/pages.hpp"
#include "web/report/reports.hpp"

namespace mavloom::web {

class Reporter {
public:
    Reporter(const dialect::Dialect& dialect, observe::Inspector& inspector, const Channels& channels,
             std::mutex& mutex);

    // All of it.
    [[nodiscard]] const std::shared_ptr<const std::string>& text(Report report) {
        return texts_[static_cast<std::size_t>(report)].get([&] { return make(report); });
    }
    [[nodiscard]] std::vector<observe::Vehicle> vehicles();
    // The text of /metrics. `server`: what the server itself counted.
    [[nodiscard]] std::string metrics(std::span<const observe::NamedCount> server);
    // Begins a turn of the table's pages. The caller holds the mutex, here and when it reads pages.
    void begin_turn();
    [[nodiscard]] Pages& traffic_pages() noexcept { return pages_; }

    void note_counts(observe::OwnCounts counts);
    void set_hops(std::vector<observe::Hop> hops);
    // Lets the model notice what does not come.
    void tick();

private:
    [[nodiscard]] std::string make(Report report);
    [[nodiscard]] std::vector<TrafficLine> all_rows();
    [[nodiscard]] std::vector<TrafficLine> rows(std::size_t begin, std::size_t end, bool all) const;
    [[nodiscard]] observe::Hop own_hop() const;

    const dialect::Dialect& dialect_;
    observe::Inspector& inspector_;
    const Channels& channels_;
    std::mutex& mutex_;
    std::array<CachedText, reports.size()> texts_{};
    Pages pages_;
    std::uint64_t turn_ = 0, last_turn_ = 0;  // as numbers of frames
    MonoTime turn_at_{}, last_turn_at_{};

    std::optional<observe::OwnCounts> own_counts_;  // guarded by mutex_, as the next
    bool has_hops_ = false;
};

}  // namespace mavloom::web
