// SPDX-License-Identifier: MIT
// What must outlive a program that uses a signing key: the last time that it signed with, and the last that it took from each sender. Kept in
// KEYFILE.state (mode 0600, replaced as a whole), read when an endpoint with the key is opened, written every two seconds while there is
// something new, by a thread of its own, and at the end. Private to module link; one owner thread; nothing happens per frame.
// Source: MAVLink guide, "Message Signing": the timestamp has to be stored, and must never go back.
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "link/signing/late_frames.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::link::detail {

class Signature;

struct KeyState {
    std::uint64_t key = 0;  // its fingerprint; 0: not known
    wire::SigningTime last_signed;
    std::vector<wire::Verifier::Stream> heard;  // sorted by key, at most Verifier::max_streams

    // Of another key than before nothing was heard: its frames are no replays under this one. True when the key is another.
    bool belong_to(const wire::SigningKey& key);
    // The later of each. True when something of this state changed.
    bool merge_heard(std::span<const wire::Verifier::Stream> streams);
};

[[nodiscard]] std::string text_of(const KeyState& state);
// Empty where the text is none of ours.
[[nodiscard]] std::optional<KeyState> parse_key_state(std::string_view text);

// One key file's state. `load` and `state` belong to the owner of KeyStates; `write` may be called by any thread.
class KeyFile {
public:
    // However the key file is written, and by whatever link: it is one.
    explicit KeyFile(const std::filesystem::path& key);

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    // Nothing there is a new state; what cannot be read or understood is an error.
    [[nodiscard]] SetupResult<void> load();
    // A file that another program has renewed meanwhile is taken into account.
    [[nodiscard]] SetupResult<void> write(KeyState wanted);

    KeyState state;
    bool changed = false;  // since it was given to the writer

private:
    std::filesystem::path path_;
    std::mutex mutex_;
    wire::SigningTime written_;  // guarded by mutex_
};

// What the endpoints with one key know together, whichever files they have it from.
struct KeyJudge {
    wire::Verifier verifier;
    LateFrames late;
};

class KeyStates {
public:
    // While a program runs its file is ahead by this much, so that one that is killed does not go back when it is started again.
    static constexpr std::uint64_t reserve_ticks = 10 * 100'000;
    static constexpr std::chrono::seconds save_interval{2};

    KeyStates() = default;
    KeyStates(const KeyStates&) = delete;
    KeyStates& operator=(const KeyStates&) = delete;
    // Writes what is there, to the tick.
    ~KeyStates();

    // The state of the key in file `path`; the first time it is read from its file, and written, and `notices` gets what a person should know of it.
    [[nodiscard]] std::shared_ptr<KeyFile> open(const std::filesystem::path& path, const wire::SigningKey& key,
                                                std::vector<std::string>& notices);
    [[nodiscard]] std::shared_ptr<KeyJudge> judge_of(const wire::SigningKey& key);
    // To be called before the first frame is signed with the key.
    static void begin_signing(KeyFile& file);
    void add(const Signature& signature) { signatures_.push_back(&signature); }
    void remove(const Signature& signature) noexcept { std::erase(signatures_, &signature); }

    // When `save` has something to look at; far away where no key is used.
    [[nodiscard]] MonoTime due() const noexcept { return due_; }
    // Gives what is new to the writer, and tells what the writer met.
    void save(MonoTime now, std::vector<std::string>& notices);

private:
    struct Job {
        std::shared_ptr<KeyFile> file;
        KeyState state;
    };

    void hand_over(const std::shared_ptr<KeyFile>& file);
    void run();
    void do_job(const Job& job);

    std::vector<std::shared_ptr<KeyFile>> files_;
    std::map<std::uint64_t, std::weak_ptr<KeyJudge>> judges_;  // by the keys' fingerprints
    std::vector<const Signature*> signatures_;
    MonoTime due_ = MonoTime::max();

    std::mutex mutex_;
    std::condition_variable work_;
    std::vector<Job> jobs_;             // guarded by mutex_
    std::vector<std::string> notices_;  // guarded by mutex_
    bool over_ = false;                 // guarded by mutex_
    bool failing_ = false;              // the writer's
    std::thread writer_;
};

}  // namespace mavloom::link::detail
