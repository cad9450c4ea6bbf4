// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include "command.hpp"
#include "frames/receiving.hpp"
#include "frames/traffic_report.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/dialect/terms.hpp"
#include "mavloom/message/format.hpp"
#include "output.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

// After Ctrl-C, the backlog is printed for at most this long if the output is a terminal. A pipe or file gets all of
// it, after a notice.
constexpr auto short_backlog = 1s;

struct ListenOptions {
    ReceiveOptions receive;
    Selection selection;
    bool json = false;
    std::string csv;  // name or id of the message
    bool stats = false;
    bool stats_only = false;

    [[nodiscard]] bool has_table() const noexcept { return stats || stats_only; }
};

class Listener {
public:
    Listener(const Common& common, const ListenOptions& options, const dialect::Dialect& dialect,
             feed::Receiver& receiver, const dialect::Message* csv)
        : common_(common),
          options_(options),
          dialect_(dialect),
          json_(dialect),
          receiver_(receiver),
          csv_(csv),
          traffic_(dialect) {}

    Exit run() {
        if (csv_ != nullptr && !options_.stats_only) message::append_csv_header(output_.buffer(), *csv_);
        const Signals signals([](void* receiver) noexcept { static_cast<feed::Receiver*>(receiver)->stop(); },
                              &receiver_);
        log_ports(common_, receiver_.endpoints());
        const auto end = options_.receive.end(mono_now());
        output_.end_at(end);
        receiver_.start(end);
        while (going_ && receiver_.wait()) {
            while (going_) {
                const auto entry = receiver_.next();
                if (!entry) break;
                handle(*entry);
            }
            if (output_.flush() != Output::State::open) going_ = false;
        }
        receiver_.stop();
        receiver_.join();
        return finish();
    }

private:
    void handle(const record::FrameQueue::Entry& entry) {
        if (!wanted(entry)) return;
        if (Signals::received() && !goes_on_after_signal()) {
            ++unprinted_;
            return;
        }
        if (options_.has_table()) traffic_.add({.frame = entry.frame, .link = entry.link, .time = entry.time});
        if (!options_.stats_only)
            print({entry.time, receiver_.link_name(entry.link), entry.frame, dialect_.find(entry.frame.id())});
        ++printed_;
        if (output_.flush_if_full() != Output::State::open || printed_ == options_.receive.count) going_ = false;
    }

    bool wanted(const record::FrameQueue::Entry& entry) const {
        return options_.selection.filter.admits(entry.frame) && (csv_ == nullptr || entry.frame.id() == csv_->id());
    }

    void print(const message::Received& received) {
        auto& out = output_.buffer();
        if (csv_ != nullptr) {
            message::append_csv_row(out, received);
        } else if (options_.json) {
            json_.append(out, received);
        } else {
            message::append_text(out, received, dialect_);
        }
    }

    bool goes_on_after_signal() {
        if (backlog_end_ == MonoTime{}) backlog_end_ = mono_now() + short_backlog;
        if (mono_now() < backlog_end_) return true;
        going_ = ::isatty(STDOUT_FILENO) == 0;
        if (going_) print_notice(common_, "printing the messages received so far; another Ctrl-C ends at once");
        backlog_end_ = MonoTime::max();
        return going_;
    }

    Exit finish() {
        if (output_.state() == Output::State::failed) return fail(output_.error());
        const auto unprinted = count_unprinted();
        if (options_.has_table()) report(unprinted);
        else log_losses(common_, receiver_.totals());
        if (unprinted != 0)
            print_notice(common_, counted(unprinted, "message") +
                                      " received but not printed: the output had stalled at the end");
        if (const auto* error = receiver_.error()) return fail(*error);
        return Signals::status(unprinted != 0 ? Exit::failed : Exit::done);
    }

    // Counts the messages that could not be printed because the output had stalled at the end. Returns 0 if the reader
    // closed the output or --count was reached.
    std::uint64_t count_unprinted() {
        const bool complete = options_.receive.count != 0 && printed_ == options_.receive.count;
        if (complete || output_.state() == Output::State::closed_by_reader) return 0;
        std::uint64_t unprinted = unprinted_ + output_.lost_lines();
        while (const auto entry = receiver_.next()) unprinted += wanted(*entry);
        return unprinted;
    }

    // Prints the table to stdout, or to stderr if stdout carries CSV rows or has stalled.
    void report(std::uint64_t unprinted) {
        const auto table = options_.json ? traffic_json(traffic_, receiver_, unprinted)
                                         : traffic_text(traffic_, receiver_);
        const bool has_rows = csv_ != nullptr && !options_.stats_only;
        if (has_rows || output_.state() == Output::State::interrupted) return write_stderr(table);
        output_.buffer().append(table);
        output_.flush();
    }

    const Common& common_;
    const ListenOptions& options_;
    const dialect::Dialect& dialect_;
    const message::JsonFormatter json_;
    feed::Receiver& receiver_;
    const dialect::Message* csv_;
    Output output_;
    observe::LatestTable traffic_;
    std::uint64_t printed_ = 0, unprinted_ = 0;
    MonoTime backlog_end_{};
    bool going_ = true;
};

Exit listen(const Common& common, ListenOptions& options) {
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    if (auto compiled = options.selection.compile(*dialect); !compiled) return fail(compiled.error());
    const dialect::Message* csv = nullptr;
    if (!options.csv.empty() && !options.selection.only.empty())
        return fail(Exit::wrong_use, fmt::format("--csv {} prints that one message; omit --only", options.csv));
    if (!options.csv.empty()) {
        const auto message = dialect::find_message(*dialect, options.csv);
        if (!message) return fail(SetupError(message.error()).within("--csv"));
        csv = *message;
    }
    auto receiver = options.receive.open(common, *dialect);
    if (!receiver) return fail(receiver.error());
    return Listener(common, options, *dialect, **receiver, csv).run();
}

}  // namespace

Run declare_listen(Arguments command, const Common& common) {
    auto options = std::make_shared<ListenOptions>();
    options->receive.declare(command);
    options->selection.declare(command);
    auto json = command.add_flag("--json", options->json, "print one JSON object per line (docs/guide/listen.md)");
    command
        .add_option("--csv", "MESSAGE", options->csv,
                    "print only this message (name or id), as CSV: a header, then one row per message")
        .excludes(json);
    command.add_flag("--stats", options->stats,
                     "after the messages, print a table of rates, gaps, bytes and loss by source and message; -q does "
                     "not leave out the messages");
    command.add_flag("--stats-only", options->stats_only,
                     "print only that table: no messages, also with --json and --csv");
    command.footer(
        "Examples:\n  mavloom listen udpin://0.0.0.0:14550\n  mavloom listen udpin://0.0.0.0:14550 --only "
        "ATTITUDE,VFR_HUD --json\n"
        "  mavloom listen flight.tlog --stats-only\n  mavloom listen shm://px4 --for 10s\n\n"
        "Exit status: 0 even if frames were lost, 130 after Ctrl-C, 1 if messages could not be printed because the\n"
        "output stalled at the end.");
    return [options, &common] { return listen(common, *options); };
}

}  // namespace mavloom::app
