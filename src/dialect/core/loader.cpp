// SPDX-License-Identifier: MIT
#include "loader.hpp"

#include <fmt/format.h>

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
    explicit IncludeWalk(Records& records) : records_(records) {}

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
        Place from;  // the <include> element; empty for the top file
    };

    void enqueue(fs::path path, Place from) {
        std::error_code ignored;  // reading an unresolvable path will fail later
        auto resolved = fs::weakly_canonical(path, ignored);
        if (seen_.insert(ignored ? path : resolved).second) queue_.push_back({std::move(path), from});
    }

    SetupResult<void> read_one(const Step& step) {
        auto file = SourceFile::read(step.path);
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
            enqueue((step.path.parent_path() / include.path).lexically_normal(), include.place);
        append(all_.enums, definitions->enums);
        append(all_.messages, definitions->messages);
        return {};
    }

    // Attributes a missing include to the including file. A malformed file keeps its own error, with its own line.
    static SetupResult<void> unreadable(const Step& step, SetupError error) {
        if (step.from.file.empty() || error.code == SetupCode::bad_input) return tl::unexpected(std::move(error));
        return setup_error(
            SetupCode::bad_input,
            fmt::format("{}: cannot include {}; expected a file beside the including one (copy the public "
                        "definitions from share/mavloom/dialects)",
                        step.from.text(), error.text));
    }

    Records& records_;
    FileDefinitions all_;
    std::deque<Step> queue_;
    std::set<fs::path> seen_;
    std::size_t files_ = 0, bytes_ = 0;
};

}  // namespace

SetupResult<FileDefinitions> read_with_includes(const fs::path& top, Records& records) {
    return IncludeWalk(records).run(top);
}

SetupResult<Dialect> Dialect::load(const fs::path& xml) {
    auto storage = std::make_shared<Storage>();
    auto definitions = read_with_includes(xml, *storage);
    if (!definitions) return tl::unexpected(std::move(definitions.error()));
    if (auto merged = merge(std::move(*definitions), *storage); !merged)
        return tl::unexpected(std::move(merged.error()));
    const auto name = storage->intern(xml.stem().string());
    return Dialect(name, std::move(storage));
}

}  // namespace mavloom::dialect
