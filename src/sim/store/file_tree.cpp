// SPDX-License-Identifier: MIT
#include "sim/store/file_tree.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <utility>

#include "mavloom/msg/enums/mav_ftp_err.hpp"
#include "mavloom/wire/crc32.hpp"
#include "sim/metadata/metadata.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

// A list entry with its size and time fits one reply, and so does a request with a path.
constexpr std::size_t longest_name = 200, longest_path = 239;
constexpr FileError not_found{MAV_FTP_ERR_FILENOTFOUND};
constexpr FileError protected_file{MAV_FTP_ERR_FILEPROTECTED};
constexpr FileError existing{MAV_FTP_ERR_FILEEXISTS};

constexpr FileError of_errno(int number) noexcept { return {MAV_FTP_ERR_FAILERRNO, static_cast<std::uint8_t>(number)}; }

tl::unexpected<FileError> fail(FileError error) { return tl::unexpected(error); }

bool is_below(std::string_view path, std::string_view folder) noexcept {
    return folder.empty() || (path.size() > folder.size() && path.starts_with(folder) && path[folder.size()] == '/');
}

// True for a folder, what is in it, and the folders above it.
bool touches(std::string_view path, std::string_view folder) noexcept {
    return path == folder || is_below(path, folder) || is_below(folder, path);
}

std::string_view parent_of(std::string_view path) noexcept {
    const std::size_t slash = path.rfind('/');
    return slash == std::string_view::npos ? std::string_view{} : path.substr(0, slash);
}

std::uint32_t unix_seconds(WallTime time) noexcept {
    return static_cast<std::uint32_t>(std::max<std::int64_t>(0, time.time_since_epoch() / std::chrono::seconds{1}));
}

void strip(std::string_view& text, std::string_view prefix) noexcept {
    if (text.starts_with(prefix)) text.remove_prefix(prefix.size());
}

// "[;comp=1]" names a component of the vehicle in an mftp URI. Only the autopilot has files.
void strip_component(std::string_view& path) noexcept {
    if (!path.starts_with("[;comp=")) return;
    const std::size_t end = path.find(']');
    if (end != std::string_view::npos) path.remove_prefix(end + 1);
}

}  // namespace

std::optional<std::string> normal_path(std::string_view path, const RecordedLogs& logs) {
    constexpr std::string_view log_alias = "@MAV_LOG";
    strip(path, "mftp://");
    strip_component(path);
    std::string normal;
    while (!path.empty()) {
        const std::size_t slash = path.find('/');
        std::string_view part = path.substr(0, slash);
        path.remove_prefix(slash == std::string_view::npos ? path.size() : slash + 1);
        if (part.empty() || part == ".") continue;
        if (part == "..") return std::nullopt;
        if (normal.empty() && part == log_alias) part = logs.folder();
        if (!normal.empty()) normal += '/';
        normal += part;
    }
    return normal;
}

template <class Visit>
void FileTree::for_each(const Visit& visit) const {
    using enum FileRef::Kind;
    const auto metadata = metadata_paths(firmware_);
    for (std::uint32_t i = 0; i < metadata.size(); ++i) visit(metadata[i], false, FileRef{shared, i}, 0u);
    visit(logs_.folder(), true, FileRef{}, 0u);
    for (std::uint16_t i = 0; i < logs_.count(); ++i)
        visit(std::string_view{logs_.path(i)}, false, FileRef{log, logs_.serial(i)}, unix_seconds(logs_.began_at(i)));
    for (const Node& node : nodes_)
        visit(std::string_view{node.path}, node.is_directory, FileRef{written, node.id}, node.modified);
}

FileResult<FileRef> FileTree::find(std::string_view path) const {
    std::optional<FileRef> found;
    for_each([&](std::string_view at, bool is_directory, const FileRef& file, std::uint32_t) {
        if (at == path && !is_directory) found = file;
    });
    if (found) return *found;
    return fail(is_directory(path) ? of_errno(EISDIR) : not_found);
}

bool FileTree::is_directory(std::string_view path) const {
    bool found = path.empty();
    for_each([&](std::string_view at, bool is_directory, const FileRef&, std::uint32_t) {
        found = found || is_below(at, path) || (is_directory && at == path);
    });
    return found;
}

FileResult<std::vector<DirectoryEntry>> FileTree::list(std::string_view path) const {
    if (!is_directory(path)) return fail(find(path) ? of_errno(ENOTDIR) : not_found);
    std::map<std::string, DirectoryEntry, std::less<>> entries;
    for_each([&](std::string_view at, bool is_directory, const FileRef& file, std::uint32_t modified) {
        if (!is_below(at, path)) return;
        const std::string_view rest = at.substr(path.empty() ? 0 : path.size() + 1);
        const std::string name(rest.substr(0, rest.find('/')));
        const bool is_child_directory = is_directory || name.size() < rest.size();
        const std::uint32_t bytes = is_child_directory ? 0 : size(file).value_or(0);
        entries.insert_or_assign(name, DirectoryEntry{name, is_child_directory, bytes, modified});
    });
    std::vector<DirectoryEntry> list;
    list.reserve(entries.size());
    for (auto& [name, entry] : entries) list.push_back(std::move(entry));
    return list;
}

std::optional<std::uint32_t> FileTree::size(const FileRef& file) const {
    switch (file.kind) {
        case FileRef::Kind::shared: return static_cast<std::uint32_t>(metadata_file(firmware_, file.number).size());
        case FileRef::Kind::log:
            if (const auto index = logs_.index_of(file.number)) return logs_.size(*index);
            return std::nullopt;
        case FileRef::Kind::written: break;
    }
    const Node* const node = find_node(file.number);
    return node == nullptr ? std::nullopt : std::optional(static_cast<std::uint32_t>(node->content.size()));
}

std::size_t FileTree::read(const FileRef& file, std::uint32_t offset, ByteSpan out) const {
    if (file.kind == FileRef::Kind::log) {
        const auto index = logs_.index_of(file.number);
        return index ? logs_.read(*index, offset, out) : 0;
    }
    ByteView content;
    if (file.kind == FileRef::Kind::shared) {
        content = metadata_file(firmware_, file.number);
    } else if (const Node* const node = find_node(file.number)) {
        content = node->content;
    }
    if (offset >= content.size()) return 0;
    const std::size_t length = std::min(out.size(), content.size() - offset);
    std::memcpy(out.data(), content.data() + offset, length);
    return length;
}

std::uint32_t FileTree::checksum(const FileRef& file) const {
    std::array<std::uint8_t, 4096> piece;
    std::uint32_t crc = 0, offset = 0;
    while (const std::size_t length = read(file, offset, piece)) {
        crc = wire::crc32(crc, ByteView(piece).first(length));
        offset += static_cast<std::uint32_t>(length);
    }
    return crc;
}

FileError FileTree::check_writable(std::string_view path) const {
    if (path.empty()) return {MAV_FTP_ERR_FAIL};
    if (path.size() > longest_path || path.size() - parent_of(path).size() > longest_name)
        return of_errno(ENAMETOOLONG);
    // The name of a special file, such as @PARAM/param.pck, is not one that a client may take.
    if (path.front() == '@' || touches(path, logs_.folder())) return protected_file;
    for (const std::string_view shared : metadata_paths(firmware_))
        if (touches(path, shared.substr(0, shared.find('/')))) return protected_file;
    return is_directory(parent_of(path)) ? FileError{} : not_found;
}

FileResult<FileRef> FileTree::open_for_writing(std::string_view path, bool may_make, bool empties, WallTime now) {
    if (const FileError error = check_writable(path); error.is_error()) return fail(error);
    Node* node = find_node(path);
    if (node == nullptr) {
        if (!may_make) return fail(not_found);
        auto made = add_node(path, false);
        if (!made) return fail(made.error());
        node = *made;
    }
    if (node->is_directory) return fail(of_errno(EISDIR));
    if (empties) (void)resize(*node, 0);
    node->modified = unix_seconds(now);
    return FileRef{FileRef::Kind::written, node->id};
}

FileError FileTree::write(const FileRef& file, std::uint32_t offset, ByteView bytes) {
    if (file.kind != FileRef::Kind::written) return protected_file;
    const auto node = std::ranges::find(nodes_, file.number, &Node::id);
    if (node == nodes_.end()) return not_found;
    const std::size_t end = std::size_t{offset} + bytes.size();
    if (end > node->content.size())
        if (const FileError error = resize(*node, end); error.is_error()) return error;
    if (!bytes.empty()) std::memcpy(node->content.data() + offset, bytes.data(), bytes.size());
    return {};
}

FileError FileTree::truncate(std::string_view path, std::uint32_t size) {
    if (const FileError error = check_writable(path); error.is_error()) return error;
    Node* const node = find_node(path);
    if (node == nullptr) return not_found;
    return node->is_directory ? of_errno(EISDIR) : resize(*node, size);
}

FileError FileTree::remove(std::string_view path) {
    if (const FileError error = check_writable(path); error.is_error()) return error;
    const Node* const node = find_node(path);
    if (node == nullptr) return not_found;
    if (node->is_directory) return of_errno(EISDIR);
    written_bytes_ -= node->content.size();
    nodes_.erase(nodes_.begin() + (node - nodes_.data()));
    return {};
}

FileError FileTree::make_directory(std::string_view path) {
    if (const FileError error = check_writable(path); error.is_error()) return error;
    if (find_node(path) != nullptr) return existing;
    const auto made = add_node(path, true);
    return made ? FileError{} : made.error();
}

FileError FileTree::remove_directory(std::string_view path) {
    if (const FileError error = check_writable(path); error.is_error()) return error;
    const Node* const node = find_node(path);
    if (node == nullptr) return not_found;
    if (!node->is_directory) return of_errno(ENOTDIR);
    if (std::ranges::any_of(nodes_, [&](const Node& other) { return is_below(other.path, path); }))
        return of_errno(ENOTEMPTY);
    nodes_.erase(nodes_.begin() + (node - nodes_.data()));
    return {};
}

FileError FileTree::rename(std::string_view from, std::string_view to) {
    if (const FileError error = check_writable(from); error.is_error()) return error;
    if (const FileError error = check_writable(to); error.is_error()) return error;
    if (find_node(from) == nullptr) return not_found;
    if (from == to) return {};
    if (is_below(to, from)) return of_errno(EINVAL);
    if (const Node* const target = find_node(to)) {
        if (target->is_directory || find_node(from)->is_directory) return existing;
        if (const FileError error = remove(to); error.is_error()) return error;
    }
    const auto moves = [&](const Node& node) { return node.path == from || is_below(node.path, from); };
    for (const Node& node : nodes_)
        if (moves(node) && to.size() + node.path.size() - from.size() > longest_path) return of_errno(ENAMETOOLONG);
    for (Node& node : nodes_)
        if (moves(node)) node.path = std::string(to) + node.path.substr(from.size());
    return {};
}

FileError FileTree::resize(Node& node, std::size_t size) {
    const std::size_t others = written_bytes_ - node.content.size();
    if (size > limits_.file_bytes || others > limits_.file_bytes - size) return of_errno(ENOSPC);
    node.content.resize(size);
    if (size == 0) node.content.shrink_to_fit();
    written_bytes_ = others + size;
    return {};
}

FileTree::Node* FileTree::find_node(std::string_view path) noexcept {
    const auto at = std::ranges::find(nodes_, path, &Node::path);
    return at == nodes_.end() ? nullptr : &*at;
}

const FileTree::Node* FileTree::find_node(std::uint32_t id) const noexcept {
    const auto at = std::ranges::find(nodes_, id, &Node::id);
    return at == nodes_.end() ? nullptr : &*at;
}

FileResult<FileTree::Node*> FileTree::add_node(std::string_view path, bool is_directory) {
    if (nodes_.size() >= limits_.files) return fail(of_errno(ENOSPC));
    nodes_.push_back({.path = std::string(path), .id = ++last_id_, .is_directory = is_directory});
    return &nodes_.back();
}

}  // namespace mavloom::sim
