// SPDX-License-Identifier: MIT
// A recording of what the vehicles send or receive, with the times of the flight clock. Private to module simserve;
// single owner thread. It waits for the disk, so a slow disk slows the simulator down, and no frame is lost.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "mavloom/base/ids.hpp"
#include "mavloom/record/tlog_writer.hpp"

namespace mavloom::simserve {

class FlightRecording {
public:
    // Closed: it takes nothing.
    FlightRecording() = default;

    // See TlogWriter::create_file.
    [[nodiscard]] SetupResult<void> open(const std::filesystem::path& path, LinkId link) {
        auto created = record::TlogWriter::create_file(path);
        if (!created) return tl::unexpected(std::move(created.error()));
        writer_.emplace(std::move(*created));
        link_ = link;
        return {};
    }

    [[nodiscard]] bool is_open() const noexcept { return writer_.has_value(); }
    // The link whose frames it records; LinkId{} if there is none.
    [[nodiscard]] LinkId link() const noexcept { return link_; }
    [[nodiscard]] std::string label() const { return writer_ ? writer_->path().string() : std::string(); }
    [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }
    // After an error, it takes no more.
    [[nodiscard]] const std::optional<SetupError>& error() const noexcept { return error_; }

    void write(WallTime time, const wire::FrameView& frame) {
        if (!writer_ || error_) return;
        ++frames_;
        bytes_ += frame.size();
        keep(writer_->write(time, frame));
    }
    // Other programs then see all that was written.
    void flush() {
        if (writer_ && !error_) keep(writer_->flush());
    }
    [[nodiscard]] SetupResult<void> close() {
        if (error_) return tl::unexpected(*error_);
        return writer_ ? writer_->close() : SetupResult<void>{};
    }

private:
    void keep(SetupResult<void> done) {
        if (!done) error_ = std::move(done.error());
    }

    std::optional<record::TlogWriter> writer_;
    std::optional<SetupError> error_;
    LinkId link_{};
    std::uint64_t frames_ = 0, bytes_ = 0;
};

}  // namespace mavloom::simserve
