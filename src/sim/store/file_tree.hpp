// SPDX-License-Identifier: MIT
// The files of a vehicle that clients of MAVLink FTP see. Private to module sim; single owner.
//
// Three kinds of files share one tree: metadata, which all vehicles share; recorded logs, which are computed; and files
// that clients wrote. Clients can change only the last kind; number and size of these files are bounded. All files are
// in memory, not on a disk.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "mavloom/base/bytes.hpp"
#include "mavloom/sim/flight.hpp"
#include "sim/store/recorded_logs.hpp"

namespace mavloom::flight {
class Firmware;
}

namespace mavloom::sim {

// A refusal in the terms of MAVLink FTP: MAV_FTP_ERR, and the error number of POSIX for MAV_FTP_ERR_FAILERRNO.
struct FileError {
    std::uint8_t code = 0;  // 0: no error
    std::uint8_t number = 0;

    [[nodiscard]] bool is_error() const noexcept { return code != 0; }
    friend constexpr bool operator==(const FileError&, const FileError&) = default;
};
template <class T>
using FileResult = tl::expected<T, FileError>;

// Identifies a file that exists, or that existed when the value was created.
struct FileRef {
    enum class Kind : std::uint8_t { shared, log, written };
    Kind kind = Kind::shared;
    std::uint32_t number = 0;  // shared: of the metadata file; log: its serial; written: its id
};

struct DirectoryEntry {
    std::string name;
    bool is_directory = false;
    std::uint32_t size = 0;
    std::uint32_t modified = 0;  // Unix seconds; 0 if unknown
};

// A path as clients write it, without "mftp://", component, slashes at both ends and `.`; @MAV_LOG becomes the folder
// of logs. Empty if the path climbs above the root.
[[nodiscard]] std::optional<std::string> normal_path(std::string_view path, const RecordedLogs& logs);

class FileTree {
public:
    // The arguments must outlive the object.
    FileTree(const Firmware& firmware, const RecordedLogs& logs, const Limits& limits) noexcept
        : firmware_(firmware), logs_(logs), limits_(limits) {}

    // All paths must be in the form that normal_path returns.
    [[nodiscard]] FileResult<FileRef> find(std::string_view path) const;
    // Sorted by name.
    [[nodiscard]] FileResult<std::vector<DirectoryEntry>> list(std::string_view path) const;

    // Empty if the file was removed.
    [[nodiscard]] std::optional<std::uint32_t> size(const FileRef& file) const;
    // Returns the number of bytes read: fewer than requested at the end of the file.
    [[nodiscard]] std::size_t read(const FileRef& file, std::uint32_t offset, ByteSpan out) const;
    [[nodiscard]] std::uint32_t checksum(const FileRef& file) const;

    // `may_make`: creates the file if it does not exist. `empties`: removes the content of an existing file.
    [[nodiscard]] FileResult<FileRef> open_for_writing(std::string_view path, bool may_make, bool empties, WallTime now);
    // A gap before `offset` is filled with zeros.
    [[nodiscard]] FileError write(const FileRef& file, std::uint32_t offset, ByteView bytes);
    [[nodiscard]] FileError truncate(std::string_view path, std::uint32_t size);
    [[nodiscard]] FileError remove(std::string_view path);
    [[nodiscard]] FileError make_directory(std::string_view path);
    [[nodiscard]] FileError remove_directory(std::string_view path);
    // An existing file `to` is replaced.
    [[nodiscard]] FileError rename(std::string_view from, std::string_view to);

private:
    struct Node {
        std::string path;
        std::uint32_t id = 0;
        bool is_directory = false;
        std::vector<std::uint8_t> content{};
        std::uint32_t modified = 0;
    };
    // Calls `visit(path, is_directory, size, modified)` for every file and every directory that clients made.
    template <class Visit>
    void for_each(const Visit& visit) const;
    [[nodiscard]] bool is_directory(std::string_view path) const;
    // Returns no error if clients may create or change `path`. Its folder must exist.
    [[nodiscard]] FileError check_writable(std::string_view path) const;
    [[nodiscard]] FileError resize(Node& node, std::size_t size);
    [[nodiscard]] Node* find_node(std::string_view path) noexcept;
    [[nodiscard]] const Node* find_node(std::uint32_t id) const noexcept;
    [[nodiscard]] FileResult<Node*> add_node(std::string_view path, bool is_directory);

    const Firmware& firmware_;
    const RecordedLogs& logs_;
    const Limits& limits_;
    std::vector<Node> nodes_;        // at most Limits::files
    std::size_t written_bytes_ = 0;  // at most Limits::file_bytes
    std::uint32_t last_id_ = 0;
};

}  // namespace mavloom::sim
