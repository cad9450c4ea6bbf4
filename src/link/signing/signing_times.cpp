// SPDX-License-Identifier: MIT
#include "mavloom/link/signing_times.hpp"

#include <utility>

#include "link/signing/key_store.hpp"

namespace mavloom::link {

struct SigningTimes::Impl {
    detail::KeyStore store;
    std::shared_ptr<detail::KeyFile> file;
};

SigningTimes::SigningTimes(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
SigningTimes::SigningTimes(SigningTimes&&) noexcept = default;
SigningTimes& SigningTimes::operator=(SigningTimes&&) noexcept = default;
SigningTimes::~SigningTimes() = default;

SetupResult<SigningTimes> SigningTimes::open(const std::filesystem::path& key_file, const wire::SigningKey& key,
                                             std::vector<std::string>& notices) {
    auto impl = std::make_unique<Impl>();
    impl->file = impl->store.open(key_file, key, notices);
    if (auto begun = detail::KeyStore::begin_signing(*impl->file); !begun)
        return tl::unexpected(std::move(begun).error());
    return SigningTimes(std::move(impl));
}

wire::SigningTime SigningTimes::last() const noexcept { return impl_->file->state.last_signed; }

void SigningTimes::keep(wire::SigningTime last, MonoTime now, std::vector<std::string>& notices) {
    auto& file = *impl_->file;
    if (last > file.state.last_signed) {
        file.state.last_signed = last;
        file.changed = true;
    }
    if (now >= impl_->store.due()) impl_->store.save(now, notices);
}

}  // namespace mavloom::link
