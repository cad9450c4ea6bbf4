// SPDX-License-Identifier: MIT
#include "loader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <set>

#include "file_reader.hpp"

namespace mavloom::dialect {
namespace {

namespace fs = std::filesystem;

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

class IncludeWalk {
public:
    IncludeWalk(std::span<const PublicFile> public_files, Records& records)
        : public_files_(public_files), records_(records) {}

    SetupResult<FileDefinitions> run(const fs::path& top) {
        enqueue(top, {});
        for (; !queue_.empty(); queue_.pop_front()) {
            const auto step = queue_.front();
            if (auto done = read_one(step); !done) return tl::unexpected(std::move(done.error()));
        }
        return std::move(all_);
    }

private:
    struct Step {
        fs::path path;
        SourceLocation from;                  // the <include> element; empty for the top file
        const PublicFile* instead = nullptr;  // in place of the file at `path`, which does not exist
    };

    void enqueue(fs::path path, SourceLocation from) {
        std::error_code ignored;  // reading an unresolvable path will fail later
        const bool is_missing = fs::status(path, ignored).type() == fs::file_type::not_found;
        const PublicFile* const instead = is_missing && !from.file.empty() ? public_file(path) : nullptr;
        auto resolved = instead != nullptr ? fs::path(instead->name) : fs::weakly_canonical(path, ignored);
        if (seen_.insert(ignored ? path : resolved).second) queue_.push_back({std::move(path), from, instead});
    }

    [[nodiscard]] const PublicFile* public_file(const fs::path& path) const {
        const auto found = std::ranges::find(public_files_, path.filename().string(), &PublicFile::name);
        return found == public_files_.end() ? nullptr : &*found;
    }

    SetupResult<void> read_one(const Step& step) {
        auto file = step.instead != nullptr ? SourceFile::parse(step.instead->text, std::string(step.instead->name))
                                            : SourceFile::read(step.path);
        if (!file) return unreadable(step, std::move(file.error()));
        bytes_ += file->size_bytes();
        if (++files_ > max_files || bytes_ > max_total_bytes) {
            return setup_error(SetupCode::bad_input,
                               fmt::format("{}: too much is included; expected at most {} files and {} MiB together",
                                           file->shown(), max_files, max_total_bytes >> 20));
        }
        auto definitions = read_definitions(*file, records_);
        if (!definitions) return tl::unexpected(std::move(definitions.error()));
        for (const auto& include : definitions->includes)
            enqueue((step.path.parent_path() / include.path).lexically_normal(), include.location);
        append(all_.enums, definitions->enums);
        append(all_.messages, definitions->messages);
        return {};
    }

    // Attributes a missing include to the including file. A malformed file keeps its own error, with its own line.
    static SetupResult<void> unreadable(const Step& step, SetupError error) {
        if (step.from.file.empty() || error.code == SetupCode::bad_input) return tl::unexpected(std::move(error));
        return setup_error(
            SetupCode::bad_input,
            fmt::format("{}: cannot include {}; expected a file beside the including one, or the name of a public one, "
                        "such as common.xml",
                        step.from.text(), error.text));
    }

    std::span<const PublicFile> public_files_;
    Records& records_;
    FileDefinitions all_;
    std::deque<Step> queue_;
    std::set<fs::path> seen_;
    std::size_t files_ = 0, bytes_ = 0;
};

}  // namespace

SetupResult<FileDefinitions> read_with_includes(const fs::path& top, std::span<const PublicFile> public_files,
                                                Records& records) {
    return IncludeWalk(public_files, records).run(top);
}

}  // namespace mavloom::dialect
