// SPDX-License-Identifier: MIT
// Stores the last timestamp that was signed with a key, for a program that signs without an endpoint's `sign=`. The
// file is KEYFILE.state, which endpoints with this key use too. Source: MAVLink guide, "Message Signing": the timestamp
// must be stored and must never go back.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::link {

// One owner thread. A thread of its own writes the file.
class SigningTimes {
public:
    // `notices` receives problems that a person should know about, such as an unreadable file. Error `bad_input`: the
    // times of this key are used up.
    [[nodiscard]] static SetupResult<SigningTimes> open(const std::filesystem::path& key_file,
                                                        const wire::SigningKey& key, std::vector<std::string>& notices);
    SigningTimes(SigningTimes&&) noexcept;
    SigningTimes& operator=(SigningTimes&&) noexcept;
    // Saves the final time.
    ~SigningTimes();

    // The last time that was signed with the key. The next signature must have a later time.
    [[nodiscard]] wire::SigningTime last() const noexcept;
    // Records the last time that was signed. Call it often: every 2 s, it saves a time that is 10 s later than `last`.
    // So a program that was killed and restarted never signs the same time twice. `notices` receives errors of earlier
    // writes.
    void keep(wire::SigningTime last, MonoTime now, std::vector<std::string>& notices);

private:
    struct Impl;
    explicit SigningTimes(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mavloom::link
