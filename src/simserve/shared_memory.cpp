// SPDX-License-Identifier: MIT
#include "simserve/shared_memory.hpp"

#include <utility>

namespace mavloom::simserve {

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
    auto page = ring::OwnPage::open(name);
    if (!page) return tl::unexpected(std::move(page.error()));
    page_.emplace(std::move(*page));
    return {};
}

void SharedMemory::close() noexcept {
    ring_.reset();
    page_.reset();
}

void SharedMemory::on_link_up(LinkId link, std::string_view name) {
    if (ring_) ring_->on_link_up(link, name);
    if (page_) page_->on_link_up(link, name);
}

void SharedMemory::on_link_down(LinkId link) {
    if (ring_) ring_->on_link_down(link);
    if (page_) page_->on_link_down(link);
}

void SharedMemory::refresh_page(const link::Links& links, std::optional<link::EndpointId> inlet,
                                std::span<const ring::OwnCount> counts) {
    if (ring_) {
        ring_->note_turn(0, MonoTime{});
        ring_->refresh_page(links, inlet, counts);
    }
    if (page_) page_->refresh(links, inlet, counts);
}

std::vector<std::string> SharedMemory::maintain(const link::Links& links) {
    if (ring_) return ring_->maintain(links);
    return page_ ? page_->maintain(links) : std::vector<std::string>{};
}

}  // namespace mavloom::simserve
