// SPDX-License-Identifier: MIT
#include "simserve/shared_memory.hpp"

#include <fmt/format.h>

#include <utility>

namespace mavloom::simserve {

static constexpr unsigned page_mode = 0600;

SetupResult<void> SharedMemory::open_ring(const config::RingConfig& config, std::function<void()> ready) {
    auto opened = ring::RingTap::open(config.name, {config.capacity_bytes, config.full, config.mode}, std::move(ready));
    if (!opened) return tl::unexpected(std::move(opened.error()));
    ring_ = std::move(*opened);
    ring_name_ = config.name;
    ring_link_ = LinkId{ring_->last_link().value + 1};
    ring_->on_link_up(ring_link_, ring_link_name());
    return {};
}

SetupResult<void> SharedMemory::open_page(const std::string& name) {
    auto page = ring::RingPage::create(name, page_mode);
    if (!page) return tl::unexpected(std::move(page.error()));
    page_.emplace(std::move(*page));
    page_name_ = name;
    return {};
}

void SharedMemory::close() noexcept {
    ring_.reset();
    page_.reset();
}

void SharedMemory::on_link_up(LinkId link, std::string_view name) {
    if (ring_) ring_->on_link_up(link, name);
    if (page_) page_->name_link(link, name);
}

void SharedMemory::on_link_down(LinkId link) {
    if (ring_) ring_->on_link_down(link);
    if (page_) page_->link_removed(link);
}

void SharedMemory::refresh_page(const link::Links& links, std::optional<link::EndpointId> inlet,
                                std::span<const ring::OwnCount> counts) {
    if (ring_) {
        ring_->note_turn(0, MonoTime{});
        ring_->refresh_page(links, inlet, counts);
    }
    if (page_) page_->refresh(links.links(), links.endpoints(), inlet, {}, counts);
}

std::vector<std::string> SharedMemory::look_after(const link::Links& links) {
    if (ring_) return ring_->look_after(links);
    if (!page_ || !page_->is_removed()) return {};
    if (auto opened = open_page(page_name_); !opened) return {std::move(opened.error().text)};
    for (const auto& link : links.links()) page_->name_link(link.id, link.name);
    return {fmt::format("{}: the counter page was removed; there is a new one", page_name_)};
}

}  // namespace mavloom::simserve
