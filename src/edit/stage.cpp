// SPDX-License-Identifier: MIT
#include "mavloom/edit/stage.hpp"

#include <algorithm>

#include "edit/draft.hpp"
#include "edit/plan.hpp"

namespace mavloom::edit {

class Stage::Impl {
public:
    Impl(const dialect::Dialect& dialect, const Options& options, Plan plan)
        : dialect_(&dialect),
          filter_(options.filter),
          plan_(std::move(plan)),
          version_(options.as_version),
          resequences_(options.resequence) {
        if (options.sign_key) signer_.emplace(*options.sign_key, options.sign_link_id, options.sign_after);
    }

    Outcome forward(const wire::FrameView& frame, WallTime received, WallTime now) noexcept {
        counters_.frames.add();
        counters_.bytes.add(frame.size());
        if (!filter_.admits(frame)) return dropped(Verdict::filtered, counters_.filtered);
        if (!plan_.limiter.admit(frame, received)) return dropped(Verdict::rate_limited, counters_.rate_limited);
        auto draft = Draft::of(frame, dialect_->find(frame.id()));
        if (!draft) return untouched(frame);
        const auto version = version_.value_or(frame.version());
        if (version == wire::Version::v1 && !draft->fits_v1()) return dropped(Verdict::not_v1, counters_.not_v1);
        bool changed = draft->set_version(version);
        changed |= draft->remap(plan_.forward);
        changed |= draft->patch(plan_.patches);
        const bool signs = signer_ && version == wire::Version::v2;
        if (signer_ && !signs) counters_.not_signed.add();
        if (resequences_) draft->set_sequence(next_sequence(draft->source()));
        if (changed || signs || resequences_)
            return edited(frame, *draft,
                          signs ? wire::Signing{&*signer_, wire::SigningTime::from(now)} : wire::Signing{});
        return plain(frame, *draft);
    }

    Outcome backward(const wire::FrameView& frame) noexcept {
        counters_.backward.add();
        if (!plan_.remaps) return {Verdict::forward, frame};
        auto draft = Draft::of(frame, dialect_->find(frame.id()));
        if (!draft || !draft->remap(plan_.backward)) return {Verdict::forward, frame};
        if (frame.is_signed()) counters_.signature_removed.add();
        return {Verdict::forward, draft->write(out_, {})};
    }

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] wire::SigningTime last_signed() const noexcept {
        return signer_ ? signer_->last() : wire::SigningTime{};
    }
    [[nodiscard]] std::span<const std::string> warnings() const noexcept { return plan_.warnings; }

private:
    static Outcome dropped(Verdict verdict, Counter& counter) noexcept {
        counter.add();
        return {verdict, {}};
    }

    Outcome untouched(const wire::FrameView& frame) noexcept {
        counters_.passed_untouched.add();
        return {Verdict::forward, frame};
    }

    Outcome edited(const wire::FrameView& frame, const Draft& draft, wire::Signing signing) noexcept {
        if (frame.is_signed() && signing.signer == nullptr) counters_.signature_removed.add();
        (draft.decoded() ? counters_.reencoded : counters_.rewrapped).add();
        return {Verdict::forward, draft.write(out_, signing)};
    }

    // No option applies: re-encodes the frame, but forwards it as it came if the bytes would differ.
    Outcome plain(const wire::FrameView& frame, const Draft& draft) noexcept {
        if (!draft.decoded() || frame.is_signed()) return untouched(frame);
        const auto written = draft.write(out_, {});
        if (!std::ranges::equal(written.bytes(), frame.bytes())) return untouched(frame);
        counters_.reencoded.add();
        return {Verdict::forward, written};
    }

    std::uint8_t next_sequence(Source source) noexcept {
        return sequences_[std::size_t{source.system.value} << 8 | source.component.value]++;
    }

    const dialect::Dialect* dialect_;
    const dialect::Filter filter_;
    Plan plan_;
    std::optional<wire::Version> version_;
    std::optional<wire::Signer> signer_;
    bool resequences_;
    std::vector<std::uint8_t> sequences_ = std::vector<std::uint8_t>(65536);  // by source
    wire::FrameBuffer out_{};
    Counters counters_;
};

Stage::Stage(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Stage::~Stage() = default;

SetupResult<std::unique_ptr<Stage>> Stage::create(const dialect::Dialect& dialect, const Options& options) {
    auto plan = make_plan(dialect, options);
    if (!plan) return tl::unexpected(std::move(plan.error()));
    return std::unique_ptr<Stage>(new Stage(std::make_unique<Impl>(dialect, options, std::move(*plan))));
}

Outcome Stage::forward(const wire::FrameView& frame, WallTime received, WallTime now) noexcept {
    return impl_->forward(frame, received, now);
}
Outcome Stage::backward(const wire::FrameView& frame) noexcept { return impl_->backward(frame); }
const Counters& Stage::counters() const noexcept { return impl_->counters(); }
wire::SigningTime Stage::last_signed() const noexcept { return impl_->last_signed(); }
std::span<const std::string> Stage::warnings() const noexcept { return impl_->warnings(); }

}  // namespace mavloom::edit
