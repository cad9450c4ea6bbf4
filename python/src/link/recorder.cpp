// SPDX-License-Identifier: MIT
#include "link/recorder.hpp"

#include <fmt/format.h>

#include "errors.hpp"
#include "gil.hpp"
#include "mavloom/base/counted.hpp"
#include "strings.hpp"

namespace mavloom::python {

namespace {

constexpr std::size_t max_notices = 16;  // a disk may fill up again and again

struct Created {
    std::weak_ptr<record::Recorder> recorder;
    feed::ForkGuard fork{};
};
// Guarded by the GIL.
std::vector<Created>& created() {
    static auto& recorders = *new std::vector<Created>;  // never destroyed, as threads may outlive static objects
    return recorders;
}

}  // namespace

LinkRecorder::LinkRecorder(std::shared_ptr<feed::Channel> channel, const std::string& path)
    : channel_(std::move(channel)), notices_(std::make_shared<Notices>()) {
    auto opened = [&] {
        const WithoutGil outside;
        return record::Recorder::create(path, path, {}, [notices = notices_](std::string_view text) {
            const std::lock_guard lock(notices->mutex);
            if (notices->texts.size() < max_notices) notices->texts.emplace_back(text);
        });
    }();
    recorder_ = value_or_raise(std::move(opened));
    channel_->record_with(recorder_);
    std::erase_if(created(), [](const Created& c) { return c.recorder.expired(); });
    created().push_back({recorder_});
}

LinkRecorder::~LinkRecorder() {
    if (fork_.is_own_process() && !WithoutGil::ended()) {
        const WithoutGil outside;
        stop();
        return;
    }
    // Neither may be destroyed in a forked child or at the interpreter's end: leak them.
    static_cast<void>(new std::shared_ptr(std::move(channel_)));
    static_cast<void>(new std::shared_ptr(std::move(recorder_)));
}

void LinkRecorder::stop() noexcept {
    channel_->end_recording(recorder_);
    recorder_->stop();
}

void LinkRecorder::close() {
    if (!fork_.is_own_process()) return;
    {
        const WithoutGil outside;
        const std::lock_guard lock(mutex_);
        if (closed_) return;
        closed_ = true;
        stop();
    }
    const auto said = notices();
    const auto lost = recorder_->counters().queue_full.value() + recorder_->counters().write_error.value();
    if (lost != 0)
        raise(SetupError{SetupCode::system, 0,
                         fmt::format("{}: {} not recorded{}{}", recorder_->label(), counted(lost, "frame"),
                                     said.empty() ? "" : ": ", said.empty() ? "" : said.front())});
    for (const auto& text : said) warn(text);
}

std::vector<std::shared_ptr<record::Recorder>> LinkRecorder::all() {
    std::vector<std::shared_ptr<record::Recorder>> recorders;
    for (const Created& entry : created())
        if (auto recorder = entry.recorder.lock(); recorder && entry.fork.is_own_process())
            recorders.push_back(std::move(recorder));
    return recorders;
}

std::vector<std::string> LinkRecorder::notices() const {
    const std::lock_guard lock(notices_->mutex);
    return notices_->texts;
}

void bind_link_recorder(nb::module_& module) {
    nb::class_<LinkRecorder>(
        module, "LinkRecorder", nb::is_final(),
        "Records the frames that arrive on a link to a tlog, until it or the link is closed.\n\n"
        "A thread of its own writes the file, so a slow disk delays nothing. Frames for which there\n"
        "was no room are counted in `dropped`. Use `with`, or `close()`.\n\n"
        "If another program removes or replaces the file, a new one begins within a second. `notices`\n"
        "states that.")
        .def_prop_ro("path", [](const LinkRecorder& r) { return r.recorder().label(); })
        .def_prop_ro(
            "renamed_to", [](const LinkRecorder& r) { return r.recorder().renamed_to().string(); },
            "The new name of a file that existed at this path; empty if there was none.")
        .def_prop_ro(
            "frames", [](const LinkRecorder& r) { return r.recorder().counters().frames.value(); },
            "Frames that are in the file.")
        .def_prop_ro(
            "dropped",
            [](const LinkRecorder& r) {
                return r.recorder().counters().queue_full.value() + r.recorder().counters().write_error.value();
            },
            "Frames that were not recorded, because the disk was too slow or full.")
        .def_prop_ro(
            "notices",
            [](const LinkRecorder& r) {
                nb::list texts;
                for (const auto& text : r.notices()) texts.append(nb::str(text.data(), text.size()));
                return texts;
            },
            nb::sig("def notices(self) -> list[str]"),
            "The first 16 events that concern the file: it was removed, or could not be written for a time.")
        .def("close", &LinkRecorder::close,
             "Writes the queued frames, waits for the disk and closes the file. May be called again. Raises\n"
             "SystemFailure if frames were not recorded. Otherwise each notice becomes a RuntimeWarning.")
        .def(
            "__enter__", [](nb::object self) { return self; }, nb::sig("def __enter__(self) -> LinkRecorder"))
        .def(
            "__exit__", [](LinkRecorder& r, const nb::args&) { r.close(); },
            nb::sig("def __exit__(self, *args: object) -> None"))
        .def("__repr__", [](const LinkRecorder& r) {
            return fmt::format("<LinkRecorder {}: {}>", r.recorder().label(),
                               counted(r.recorder().counters().frames.value(), "frame"));
        });
}

}  // namespace mavloom::python
