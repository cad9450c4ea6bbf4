// SPDX-License-Identifier: MIT
#include "web/clients/streams.hpp"

#include <fmt/format.h>

#include <utility>

#include "mavloom/base/shown.hpp"
#include "mavloom/dialect/message_class.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "web/channels.hpp"

namespace mavloom::web {

namespace {

ByteView bytes_of(std::string_view text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }

SetupResult<void> narrow(StreamTerms& terms, const dialect::Dialect& dialect, const endpoint::OptionText& option) {
    const auto allow = [&](const SetupResult<dialect::FilterTerms>& parsed) {
        return parsed ? terms.filter.allow(dialect, *parsed) : tl::unexpected(parsed.error());
    };
    if (option.key == "only") return allow(endpoint::parse_filter(option.value));
    if (option.key == "from") return allow(endpoint::parse_sender(option.value));
    if (option.key != "max_rate")
        return setup_error(SetupCode::usage, "there is no such option; a stream takes only, from and max_rate");
    const auto parsed = endpoint::parse_rates(option.value);
    if (!parsed) return tl::unexpected(parsed.error());
    auto rates = dialect::Rates::compile(dialect, *parsed);
    if (!rates) return tl::unexpected(std::move(rates.error()));
    terms.max_rate = std::move(*rates);
    return {};
}

}  // namespace

SetupResult<StreamTerms> parse_stream_terms(const dialect::Dialect& dialect, std::string_view query) {
    StreamTerms terms;
    if (query.empty()) return terms;
    const auto options = endpoint::split_query(query);
    if (!options) return tl::unexpected(options.error());
    for (const auto& option : *options)
        if (auto done = narrow(terms, dialect, option); !done)
            return tl::unexpected(std::move(done.error()).within(printable(option.key)));
    return terms;
}

void Streams::add(const std::shared_ptr<http::Session>& session, const StreamTerms& terms) {
    all_.emplace(session.get(), std::make_unique<Stream>(
                                    Stream{session, terms.filter, dialect::RateLimiter<MonoTime>(terms.max_rate)}));
}

void Streams::remove(const http::Session& session) { all_.erase(&session); }

void Streams::publish(const observe::Heard& heard) {
    if (all_.empty()) return;
    const auto* const message = dialect_.find(heard.frame.id());
    const auto message_class = dialect::class_of(heard.frame.id(), message == nullptr ? nullptr : &message->wire);
    line_.clear();
    for (const auto& [session, stream] : all_) {
        if (!stream->filter.admits(heard.frame) || !stream->limiter.admit(heard.frame, heard.now)) continue;
        if (line_.size() == 0) json_.append(line_, {heard.time, heard.link_name, heard.frame, message});
        stream->session->push(bytes_of({line_.data(), line_.size()}), static_cast<std::uint8_t>(message_class), 0,
                              heard.now);
        stream->has_new = true;
    }
}

void Streams::flush(MonoTime now) {
    for (const auto& [key, stream] : all_) {
        if (!std::exchange(stream->has_new, false)) continue;
        const auto& session = stream->session;
        if (const auto drops = stream->drops.news(*session, now))
            session->push(bytes_of(fmt::format("{{\"dropped\":{}}}\n", *drops)), essential_class, 0, now);
        session->flush();
    }
}

}  // namespace mavloom::web
