// SPDX-License-Identifier: MIT
#include "link/signing/key_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "link/signing/signature.hpp"
#include "mavloom/base/thread.hpp"
#include "mavloom/net/fd.hpp"

namespace mavloom::link::detail {

using Stream = wire::Verifier::Stream;

namespace {

constexpr std::string_view heading = "mavloom signing times 1";
constexpr std::uint64_t time_limit = wire::SigningTime::limit;
// Larger than a file of max_streams lines.
constexpr std::size_t max_file_bytes = 256 * 1024;
constexpr std::uint64_t clock_tolerance_ticks = 60 * 100'000;

std::string_view take_until(std::string_view& text, char end) noexcept {
    const auto at = text.find(end);
    const auto word = text.substr(0, at);
    text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
    return word;
}

std::optional<std::uint64_t> take_number(std::string_view& line, std::uint64_t limit) noexcept {
    const auto word = take_until(line, ' ');
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || value >= limit) return std::nullopt;
    return value;
}

bool read_line(std::string_view line, KeyState& state) {
    const auto what = take_until(line, ' ');
    if (what == "signed") {
        const auto ticks = take_number(line, time_limit);
        if (ticks) state.last_signed = {*ticks};
        return ticks && line.empty();
    }
    if (what == "key") {
        const auto fingerprint = take_number(line, std::numeric_limits<std::uint64_t>::max());
        state.key = fingerprint.value_or(0);
        return fingerprint && line.empty();
    }
    const auto link = take_number(line, 256), system = take_number(line, 256), component = take_number(line, 256);
    const auto ticks = take_number(line, time_limit);
    if (what != "heard" || !link || !system || !component || !ticks || !line.empty()) return false;
    const Stream stream{static_cast<std::uint32_t>(*link << 16 | *system << 8 | *component), {*ticks}};
    state.merge_heard({&stream, 1});
    return true;
}

SetupResult<std::string> read_file(const std::filesystem::path& path) {
    // O_NONBLOCK: if the path is a pipe, do not wait for its writer.
    const net::Fd file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (!file && errno == ENOENT) return std::string();
    struct stat status {};
    if (file && (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)))
        return setup_error(SetupCode::bad_input,
                           fmt::format("{} is not a regular file; signing times start over", path.string()));
    std::string text(max_file_bytes, '\0');
    const ssize_t size = !file ? -1 : ::read(file.get(), text.data(), text.size());
    if (size < 0) return system_error(fmt::format("cannot read {}", path.string()), errno);
    text.resize(static_cast<std::size_t>(size));
    return text;
}

int replace_file(const std::filesystem::path& path, std::string_view text) noexcept {
    const auto fresh = fmt::format("{}.{}", path.string(), ::getpid());
    const net::Fd file(::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0600));
    if (!file) return errno;
    const ssize_t took = ::write(file.get(), text.data(), text.size());
    int error = took < 0 ? errno : took != static_cast<ssize_t>(text.size()) ? ENOSPC : 0;
    if (error == 0 && ::fsync(file.get()) != 0) error = errno;
    if (error == 0 && ::rename(fresh.c_str(), path.c_str()) != 0) error = errno;
    if (error == 0) return 0;
    ::unlink(fresh.c_str());
    return error;
}

}  // namespace

// ---- state and its file ---------------------------------------------------------------------------------------------

bool KeyState::belong_to(const wire::SigningKey& now) {
    const std::uint64_t before = std::exchange(key, now.fingerprint());
    if (before != 0 && before != key) heard.clear();
    return before != key;
}

bool KeyState::merge_heard(std::span<const Stream> streams) {
    bool changed = false;
    for (const Stream& stream : streams) {
        const auto at = std::ranges::lower_bound(heard, stream.key, {}, &Stream::key);
        if (at != heard.end() && at->key == stream.key) {
            changed = changed || stream.last > at->last;
            at->last = std::max(at->last, stream.last);
        } else if (heard.size() < wire::Verifier::max_streams) {
            heard.insert(at, stream);
            changed = true;
        } else if (const auto oldest = std::ranges::min_element(heard, {}, &Stream::last); oldest->last < stream.last) {
            heard.erase(oldest);
            heard.insert(std::ranges::lower_bound(heard, stream.key, {}, &Stream::key), stream);
            changed = true;
        }
    }
    return changed;
}

std::string text_of(const KeyState& state) {
    std::string text = fmt::format("{}\nsigned {}\n", heading, std::min(state.last_signed.ticks, time_limit - 1));
    if (state.key != 0) fmt::format_to(std::back_inserter(text), "key {}\n", state.key);
    for (const auto& [key, last] : state.heard)
        fmt::format_to(std::back_inserter(text), "heard {} {} {} {}\n", key >> 16, key >> 8 & 0xFF, key & 0xFF,
                       last.ticks);
    return text;
}

std::optional<KeyState> parse_key_state(std::string_view text) {
    KeyState state;
    if (take_until(text, '\n') != heading) return std::nullopt;
    while (!text.empty())
        if (!read_line(take_until(text, '\n'), state)) return std::nullopt;
    return state;
}

KeyFile::KeyFile(const std::filesystem::path& key) : path_(endpoint::canonical_path(key).string() + ".state") {}

SetupResult<void> KeyFile::load() {
    const auto text = read_file(path_);
    if (!text) return tl::unexpected(text.error());
    if (text->empty()) return {};
    auto read = parse_key_state(*text);
    if (!read)
        return setup_error(SetupCode::bad_input,
                           fmt::format("{} does not contain signing times; they start over", path_.string()));
    state = std::move(*read);
    written_ = state.last_signed;
    return {};
}

SetupResult<void> KeyFile::write(KeyState wanted) {
    const std::lock_guard lock(mutex_);
    if (const auto text = read_file(path_)) {
        if (const auto there = parse_key_state(*text)) {
            if (there->key == wanted.key || there->key == 0) wanted.merge_heard(there->heard);
            if (there->last_signed > written_) wanted.last_signed = std::max(wanted.last_signed, there->last_signed);
        }
    }
    if (const int error = replace_file(path_, text_of(wanted)); error != 0)
        return system_error(
            fmt::format("cannot write {}: after a restart, old signed frames could be replayed", path_.string()), error);
    written_ = wanted.last_signed;
    return {};
}

// ---- saving ---------------------------------------------------------------------------------------------------------

static KeyState with_reserve(KeyState state) {
    if (state.last_signed.ticks != 0)
        state.last_signed.ticks = std::min(state.last_signed.ticks + KeyStore::reserve_ticks, time_limit - 1);
    return state;
}

// Returns by how many seconds the latest stored timestamp is ahead of the clock, or 0 if by a minute or less. If it is
// ahead, the clock was wrong then or is wrong now.
static std::uint64_t seconds_ahead(const KeyState& state, wire::SigningTime now) {
    std::uint64_t latest = state.last_signed.ticks;
    for (const auto& stream : state.heard) latest = std::max(latest, stream.last.ticks);
    const std::uint64_t accepted = now.ticks + clock_tolerance_ticks;
    return latest > accepted ? (latest - now.ticks) / 100'000 : 0;
}

KeyStore::~KeyStore() {
    if (writer_.joinable()) {
        {
            const std::lock_guard lock(mutex_);
            over_ = true;
        }
        work_.notify_one();
        writer_.join();
    }
    for (const auto& file : files_) (void)file->write(file->state);
}

// The time up to which earlier runs signed. A program that was killed left a time with the reserve, which may be later
// than all signatures.
static wire::SigningTime signed_until(const KeyState& state, wire::SigningTime now) noexcept {
    const std::uint64_t stored = state.last_signed.ticks;
    return {std::max(stored - std::min(stored, KeyStore::reserve_ticks), std::min(stored, now.ticks))};
}

std::shared_ptr<KeyFile> KeyStore::open(const std::filesystem::path& path, const wire::SigningKey& key,
                                        std::vector<std::string>& notices) {
    auto file = std::make_shared<KeyFile>(path);
    const auto open = std::ranges::find_if(files_, [&](const auto& f) { return f->path() == file->path(); });
    if (open != files_.end()) {
        (*open)->changed = (*open)->state.belong_to(key) || (*open)->changed;
        return *open;
    }
    const auto now = wire::SigningTime::from(wall_now());
    if (const auto loaded = file->load(); !loaded) notices.push_back(loaded.error().text);
    file->state.belong_to(key);
    if (const auto ahead = seconds_ahead(file->state, now); ahead != 0)
        notices.push_back(fmt::format("{}: its times are {} s ahead of the clock; signing continues from there",
                                      file->path().string(), ahead));
    if (const auto written = file->write(file->state); !written) notices.push_back(written.error().text);
    files_.push_back(file);
    if (const auto known = shared_keys_.find(key.fingerprint()); known != shared_keys_.end())
        if (const auto shared = known->second.lock()) shared->seen.treat_as_own_until(signed_until(file->state, now));
    due_ = std::min(due_, mono_now() + save_interval);
    return file;
}

std::shared_ptr<SharedKey> KeyStore::shared_key(const wire::SigningKey& key) {
    auto& known = shared_keys_[key.fingerprint()];
    auto shared = known.lock();
    if (shared) return shared;
    known = shared = std::make_shared<SharedKey>(SharedKey{.verifier = wire::Verifier(key)});
    for (const auto& file : files_) {
        if (file->state.key != key.fingerprint()) continue;
        for (const auto& stream : file->state.heard) shared->verifier.restore(stream);
        shared->seen.treat_as_own_until(signed_until(file->state, wire::SigningTime::from(wall_now())));
    }
    return shared;
}

void KeyStore::note_heard(const wire::FrameView& frame, WallTime time, MonoTime now) noexcept {
    if (!frame.is_signed()) return;
    const auto sender = wire::Verifier::stream_of(frame).key;
    compares_heard = false;
    for (const auto& [fingerprint, known] : shared_keys_) {
        const auto shared = known.lock();
        if (!shared || !shared->compares_heard) continue;
        compares_heard = true;
        if (!shared->verifier.is_of_key(frame)) continue;
        const auto refused_until = shared->verifier.refused_until(sender, wire::SigningTime::from(time));
        (void)shared->seen.hear(frame, now, refused_until);
    }
}

SetupResult<void> KeyStore::begin_signing(KeyFile& file) {
    if (file.state.last_signed.ticks + reserve_ticks >= time_limit)
        return setup_error(SetupCode::bad_input, fmt::format("{}: the signing times of this key are used up; create a "
                                                             "new key for both sides with mavloom key new",
                                                             file.path().string()));
    file.state.last_signed = std::max(file.state.last_signed, wire::SigningTime::from(wall_now()));
    (void)file.write(with_reserve(file.state));  // `open` has already reported any error
    return {};
}

void KeyStore::save(MonoTime now, std::vector<std::string>& notices) {
    due_ = now + save_interval;
    for (const Signature* signature : signatures_) signature->keep_times();
    for (const auto& file : files_)
        if (std::exchange(file->changed, false)) hand_over(file);
    const std::lock_guard lock(mutex_);
    std::ranges::move(notices_, std::back_inserter(notices));
    notices_.clear();
}

// Replaces a job for the same file that is still waiting.
void KeyStore::hand_over(const std::shared_ptr<KeyFile>& file) {
    {
        const std::lock_guard lock(mutex_);
        std::erase_if(jobs_, [&](const Job& job) { return job.file == file; });
        jobs_.push_back({file, with_reserve(file->state)});
    }
    work_.notify_one();
    if (!writer_.joinable()) writer_ = thread_without_signals([this] { run(); });
}

void KeyStore::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        work_.wait(lock, [&] { return over_ || !jobs_.empty(); });
        if (over_) return;
        const auto jobs = std::exchange(jobs_, {});
        lock.unlock();
        for (const Job& job : jobs) do_job(job);
        lock.lock();
    }
}

// Reports a failure once, until a write succeeds.
void KeyStore::do_job(const Job& job) {
    const auto written = job.file->write(job.state);
    if (!written && !failing_) {
        const std::lock_guard lock(mutex_);
        notices_.push_back(written.error().text);
    }
    failing_ = !written;
}

}  // namespace mavloom::link::detail
