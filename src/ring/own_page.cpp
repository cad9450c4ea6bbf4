// SPDX-License-Identifier: MIT
#include "mavloom/ring/own_page.hpp"

#include <fmt/format.h>

namespace mavloom::ring {

static constexpr unsigned page_mode = 0600;

SetupResult<OwnPage> OwnPage::open(const std::string& name) {
    auto page = RingPage::create(name, page_mode);
    if (!page) return tl::unexpected(std::move(page.error()));
    return OwnPage(name, std::move(*page));
}

void OwnPage::refresh(const link::Links& links, std::optional<link::EndpointId> inlet, std::span<const OwnCount> own) {
    due_ = MonoTime::max();
    page_.refresh(links.links(), links.endpoints(), inlet, {}, own);
}

std::vector<std::string> OwnPage::maintain(const link::Links& links) {
    if (!page_.is_removed()) return {};
    auto page = RingPage::create(name_, page_mode);
    if (!page) {
        if (std::exchange(has_reported_, true)) return {};
        return {std::move(page.error().text)};
    }
    has_reported_ = false;
    page_ = std::move(*page);
    for (const auto& link : links.links()) page_.name_link(link.id, link.name);
    due_ = MonoTime{};
    return {fmt::format("{}: the counter page was removed; there is a new one", name_)};
}

}  // namespace mavloom::ring
