// SPDX-License-Identifier: MIT
// Stores the signing timestamps that must survive a restart: the last one signed with each key, and the last one
// accepted from each sender.
//
// They are kept in KEYFILE.state (mode 0600, replaced atomically). The file is read when the first endpoint with the
// key opens. A writer thread saves changes every two seconds, and the destructor saves the final state. No work is
// done per frame. Private to module link; single owner thread apart from the writer. Source: MAVLink guide, "Message
// Signing": the timestamp must be stored and must never go back.
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

#include "link/signing/seen_signatures.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::link::detail {

class Signature;

struct KeyState {
    std::uint64_t key = 0;  // the key's fingerprint; 0: unknown
    wire::SigningTime last_signed;
    std::vector<wire::Verifier::Stream> heard;  // sorted by key, at most Verifier::max_streams

    // Assigns the state to this key and returns true if that changes `key`. If the state belonged to another key,
    // clears `heard`, because timestamps under one key do not reveal replays under another.
    bool belong_to(const wire::SigningKey& key);
    // Keeps the later timestamp of each stream. Returns true if something changed.
    bool merge_heard(std::span<const wire::Verifier::Stream> streams);
};

[[nodiscard]] std::string text_of(const KeyState& state);
// Empty if the text is not a state file of this format.
[[nodiscard]] std::optional<KeyState> parse_key_state(std::string_view text);

// The state of one key file. Only the owner thread of KeyStore may use `load` and `state`; any thread may call
// `write`.
class KeyFile {
public:
    // All spellings of a path, and links to it, lead to the same state file.
    explicit KeyFile(const std::filesystem::path& key);

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    // A missing or empty file is a new state. An unreadable or malformed one is an error.
    [[nodiscard]] SetupResult<void> load();
    // Writes the state, merged with changes that another program has made to the file in the meantime.
    [[nodiscard]] SetupResult<void> write(KeyState wanted);

    KeyState state;
    bool changed = false;  // since it was last passed to the writer

private:
    std::filesystem::path path_;
    std::mutex mutex_;
    wire::SigningTime written_;  // guarded by mutex_
};

// State that all endpoints with one key share, whichever file each loaded the key from.
struct SharedKey {
    wire::Verifier verifier;
    SeenSignatures seen{};
    bool compares_heard = false;  // some endpoint verifies, so it must know what the others hear
};

class KeyStore {
public:
    // The signing time in the file is this much (10 s) ahead of the time in use. After a kill and a restart, the
    // program therefore never reuses a timestamp.
    static constexpr std::uint64_t reserve_ticks = 10 * 100'000;
    static constexpr std::chrono::seconds save_interval{2};

    KeyStore() = default;
    KeyStore(const KeyStore&) = delete;
    KeyStore& operator=(const KeyStore&) = delete;
    // Saves the final state, without the reserve.
    ~KeyStore();

    // Returns the state of the key file `path`. The first call for a file reads and rewrites its state; `notices`
    // receives problems that a person should know about.
    [[nodiscard]] std::shared_ptr<KeyFile> open(const std::filesystem::path& path, const wire::SigningKey& key,
                                                std::vector<std::string>& notices);
    // The shared state of a key. Call it before `begin_signing`.
    [[nodiscard]] std::shared_ptr<SharedKey> shared_key(const wire::SigningKey& key);
    // Call it for frames of endpoints without verify=. If such a frame is signed with the key of an endpoint with
    // verify=, that endpoint then knows that it was not the first to hear the frame.
    void note_heard(const wire::FrameView& frame, WallTime time, MonoTime now) noexcept;
    // Call it before signing the first frame with the key. An error if the key's times are used up.
    [[nodiscard]] static SetupResult<void> begin_signing(KeyFile& file);
    // Whether the endpoints are used like separate programs, so that one may hear what another has signed.
    bool endpoints_are_independent = false;
    bool compares_heard = false;  // for some key, so `note_heard` must be called
    void add(const Signature& signature) { signatures_.push_back(&signature); }
    void remove(const Signature& signature) noexcept { std::erase(signatures_, &signature); }

    // When to call `save` next; MonoTime::max() if no key is in use.
    [[nodiscard]] MonoTime due() const noexcept { return due_; }
    // Passes changes to the writer thread, and appends the writer's errors to `notices`.
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
    std::map<std::uint64_t, std::weak_ptr<SharedKey>> shared_keys_;  // by key fingerprint
    std::vector<const Signature*> signatures_;
    MonoTime due_ = MonoTime::max();

    std::mutex mutex_;
    std::condition_variable work_;
    std::vector<Job> jobs_;             // guarded by mutex_
    std::vector<std::string> notices_;  // guarded by mutex_
    bool over_ = false;                 // guarded by mutex_
    bool failing_ = false;              // used by the writer only
    std::thread writer_;
};

}  // namespace mavloom::link::detail
