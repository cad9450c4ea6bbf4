// SPDX-License-Identifier: MIT
#include "control/fault_request.hpp"

#include <optional>
#include <utility>

#include "mavloom/endpoint/grammar.hpp"
#include "mavloom/fault/faults.hpp"

namespace mavloom::control {

namespace {

using Word = std::optional<std::string>;

// Stores the request's text. Leaves `target` empty if the request does not have the key.
SetupResult<void> put_text(const Json& request, const char* key, Word& target) {
    const auto at = request.find(key);
    if (at == request.end()) return {};
    if (!at->is_string()) return endpoint::usage(fmt::format("'{}' is not a text", key));
    target = at->get<std::string>();
    return {};
}

// The seed may also be a number.
SetupResult<void> put_seed(const Json& request, Word& target) {
    const auto at = request.find("seed");
    if (at == request.end() || !at->is_number()) return put_text(request, "seed", target);
    target = at->dump();
    return {};
}

SetupResult<fault::Change> change_of(const Json& request) {
    fault::Change change;
    if (auto done = put_text(request, "in", change.in); !done) return tl::unexpected(std::move(done.error()));
    if (auto done = put_text(request, "out", change.out); !done) return tl::unexpected(std::move(done.error()));
    if (auto done = put_seed(request, change.seed); !done) return tl::unexpected(std::move(done.error()));
    return change;
}

}  // namespace

Report set_faults(link::Links& links, const Json& request, const std::function<void(const std::string& text)>& report) {
    const auto wanted = change_of(request);
    if (!wanted) return failed(wanted.error().text);
    const auto name = text_at(request, "name");
    const auto now = fault::change(links, name, *wanted);
    if (!now) return failed(now.error().text);
    report(fmt::format("{}: faults set by ctl: {}", name, *now));
    return succeeded();
}

}  // namespace mavloom::control
