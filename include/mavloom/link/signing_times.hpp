// SPDX-License-Identifier: MIT
// Keeps the last time that was signed with a key in KEYFILE.state, for a program that signs outside of an endpoint's
// `sign=`. Endpoints with this key use the same file. Source: MAVLink guide, "Message Signing": the timestamp must be
// stored and must never go back.
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
    // Records the last time that was signed. Call it often: it saves the time every 2 s, with a reserve. A program that
    // was killed and restarted then never signs the same time twice. `notices` receives errors of earlier writes.
    void keep(wire::SigningTime last, MonoTime now, std::vector<std::string>& notices);

private:
    struct Impl;
    explicit SigningTimes(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mavloom::link
