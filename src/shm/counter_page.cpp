// SPDX-License-Identifier: MIT
#include "mavloom/shm/counter_page.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <numeric>
#include <utility>

#include "mavloom/base/shown.hpp"
#include "shm/counter_page_layout.hpp"
#include "shm/segment.hpp"

namespace mavloom::shm {

static_assert(sizeof(CounterSlot::label) == longest_label && sizeof(LinkSlot::name) == longest_link_name);
static_assert(sizeof(Counter) == sizeof(SharedWords::Word64));

namespace {

constexpr std::string_view page_suffix = ".stat";
constexpr std::size_t owner_byte = 0;
constexpr int max_reads = 100;

std::size_t page_bytes(std::uint32_t counters, std::uint32_t links) {
    return page_header_bytes + sizeof(CounterSlot) * counters + sizeof(LinkSlot) * links;
}

CounterSlot* counters_in(const Segment& segment) noexcept {
    return reinterpret_cast<CounterSlot*>(segment.data() + page_header_bytes);
}

LinkSlot* links_in(const Segment& segment, std::uint32_t counters) noexcept {
    return reinterpret_cast<LinkSlot*>(segment.data() + page_header_bytes + sizeof(CounterSlot) * counters);
}

// Returns a checked copy of the page's header. Reads the file and not the mapping, like open_ring().
SetupResult<PageHeader> header_of(const Segment& segment) {
    PageHeader header;
    std::array<std::uint8_t, sizeof header> bytes{};
    if (segment.read_begin(bytes) == bytes.size()) std::memcpy(&header, bytes.data(), sizeof header);
    const auto wrong = [&](std::string_view what) {
        return setup_error(SetupCode::bad_input, fmt::format("{}: {}", segment.path(), what));
    };
    if (header.magic != page_magic) return wrong("is not a Mavloom counter page");
    if (header.byte_order != byte_order_mark) return wrong("is a counter page of another byte order");
    if (header.major != page_major)
        return wrong(fmt::format("is a counter page of version {}.{}; this program supports {}.{}", header.major,
                                 header.minor, page_major, page_minor));
    if (header.counters > max_page_slots || header.links > max_page_slots ||
        segment.size() < page_bytes(header.counters, header.links))
        return wrong("is a truncated counter page");
    return header;
}

// ---- text stored in atomic words, guarded by a version

template <std::size_t n>
void store_text(std::array<SharedWords::Word64, n>& words, std::string_view text) noexcept {
    std::array<std::uint64_t, n> copy{};
    std::memcpy(copy.data(), text.data(), std::min(text.size(), sizeof copy));
    for (std::size_t i = 0; i < n; ++i) words[i].store(copy[i], std::memory_order_release);
}

// Returns the text before the first NUL, and the one between that and the next NUL.
template <std::size_t n>
std::pair<std::string, std::string> load_texts(const std::array<SharedWords::Word64, n>& words) {
    std::array<std::uint64_t, n> copy;
    for (std::size_t i = 0; i < n; ++i) copy[i] = words[i].load(std::memory_order_acquire);
    const std::string_view all(reinterpret_cast<const char*>(copy.data()), sizeof copy);
    const auto first = all.substr(0, all.find('\0'));
    const auto rest = all.substr(std::min(first.size() + 1, all.size()));
    return {printable(first), printable(rest.substr(0, rest.find('\0')))};
}

// Every word is stored with release and loaded with acquire. So a reader that sees any new word also sees that the
// version is odd or has changed.
template <class Slot, class Change>
void change(Slot& slot, Change&& make) noexcept {
    // Already odd if a writer was killed during a change.
    const std::uint64_t version = slot.version.load(std::memory_order_relaxed) | 1;
    slot.version.store(version, std::memory_order_release);
    make(slot);
    slot.version.store(version + 1, std::memory_order_release);
}

// Returns what `look` reads from a slot that does not change during the read. Returns nothing if the slot keeps
// changing.
template <class Slot, class Look>
auto read_slot(const Slot& slot, Look&& look) -> std::optional<decltype(look(slot))> {
    for (int attempt = 0; attempt < max_reads; ++attempt) {
        const std::uint64_t before = slot.version.load(std::memory_order_acquire);
        auto found = look(slot);
        if (before % 2 == 0 && slot.version.load(std::memory_order_acquire) == before) return found;
    }
    return std::nullopt;
}

std::optional<CounterValue> value_in(const CounterSlot& slot) {
    const std::uint32_t type = slot.type.load(std::memory_order_acquire);
    if (type < 1 || type > 3) return std::nullopt;
    CounterValue value;
    value.type = static_cast<CounterType>(type);
    const std::uint32_t link = slot.link.load(std::memory_order_acquire);
    if (link != no_link) value.link = LinkId{link};
    value.label = load_texts(slot.label).first;
    value.value = slot.value.load(std::memory_order_acquire);
    return value;
}

struct NamedLink {
    LinkId id;
    std::string name, sends_to;
};

std::optional<NamedLink> link_in(const LinkSlot& slot) {
    if (slot.used.load(std::memory_order_acquire) == 0) return std::nullopt;
    const LinkId link{slot.link.load(std::memory_order_acquire)};
    auto [name, sends_to] = load_texts(slot.name);
    return NamedLink{link, std::move(name), std::move(sends_to)};
}

std::string text_of_link(std::string_view name, std::string_view sends_to) {
    std::string text(name);
    if (sends_to.empty() || name.size() + 1 + sends_to.size() > longest_link_name) return text;
    text += '\0';
    text += sends_to;
    return text;
}

std::vector<std::uint32_t> all_slots(std::uint32_t count) {
    std::vector<std::uint32_t> slots(count);
    std::iota(slots.rbegin(), slots.rend(), 0u);
    return slots;
}

std::optional<std::uint32_t> take_last(std::vector<std::uint32_t>& slots) noexcept {
    if (slots.empty()) return std::nullopt;
    const std::uint32_t slot = slots.back();
    slots.pop_back();
    return slot;
}

SetupResult<void> check_options(const CounterPageOptions& options) {
    if (options.counters > max_page_slots || options.links > max_page_slots)
        return setup_error(SetupCode::usage,
                           fmt::format("a counter page has room for at most {} counters and links", max_page_slots));
    return {};
}

tl::unexpected<SetupError> has_owner(const Segment& segment) {
    const auto header = header_of(segment);
    return setup_error(held_code(segment), fmt::format("{} belongs to process {}, which is alive", segment.path(),
                                                       header ? header->pid : 0));
}

SetupResult<Segment> create_page(const std::string& path, const CounterPageOptions& options) {
    PageHeader header;
    header.counters = options.counters;
    header.links = options.links;
    header.started_ns = wall_now().time_since_epoch().count();
    header.pid = static_cast<std::uint32_t>(::getpid());
    std::array<std::uint8_t, sizeof header> bytes;
    std::memcpy(bytes.data(), &header, sizeof header);
    return Segment::create(path, page_bytes(options.counters, options.links), options.mode, bytes);
}

}  // namespace

SetupResult<CounterPage> CounterPage::create(std::string_view name, const CounterPageOptions& options) {
    if (auto good = check_name(name); !good) return tl::unexpected(std::move(good.error()));
    if (auto good = check_options(options); !good) return tl::unexpected(std::move(good.error()));
    const std::string path = path_of(name, page_suffix);
    std::string set_aside;
    for (int attempt = 0; attempt < max_reads; ++attempt) {
        auto created = create_page(path, options);
        if (created) {
            CounterPage page(std::make_unique<Segment>(std::move(*created)), options);
            page.set_aside_ = std::move(set_aside);
            return page;
        }
        if (created.error().code != SetupCode::in_use) return tl::unexpected(std::move(created.error()));
        auto present = Segment::open(path, Segment::Access::read_write, 0, check_owner);
        if (!present && present.error().code == SetupCode::not_found) continue;
        if (!present && options.sets_aside && rename_aside(path)) {
            set_aside = std::move(present.error().text);
            continue;
        }
        if (!present) return tl::unexpected(std::move(present.error()));
        if (!present->try_lock(owner_byte) && present->is_locked(owner_byte)) return has_owner(*present);
        if (auto unlinked = present->unlink(); !unlinked) return tl::unexpected(std::move(unlinked.error()));
    }
    return setup_error(SetupCode::in_use, fmt::format("{} keeps being created and removed by other processes", path));
}

CounterPage::CounterPage(std::unique_ptr<Segment> segment, const CounterPageOptions& options)
    : segment_(std::move(segment)),
      slots_(options.counters),
      free_counters_(all_slots(options.counters)),
      free_links_(all_slots(options.links)) {}

CounterPage::CounterPage(CounterPage&&) noexcept = default;
CounterPage::~CounterPage() { end(); }

CounterPage& CounterPage::operator=(CounterPage&& other) noexcept {
    if (this == &other) return *this;
    end();
    segment_ = std::move(other.segment_);
    set_aside_ = std::move(other.set_aside_);
    slots_ = other.slots_;
    free_counters_ = std::move(other.free_counters_);
    free_links_ = std::move(other.free_links_);
    links_ = std::move(other.links_);
    return *this;
}

// After fork(), the child leaves the page alone: it belongs to the parent.
void CounterPage::end() noexcept {
    if (segment_ && !segment_->forked()) static_cast<void>(segment_->unlink());
    segment_.reset();
}

Counter* CounterPage::add(std::string_view label, CounterType type, std::optional<LinkId> link) noexcept {
    const auto index = take_last(free_counters_);
    if (!index) return nullptr;
    CounterSlot& slot = counters_in(*segment_)[*index];
    change(slot, [&](CounterSlot& s) {
        s.value.store(0, std::memory_order_release);
        s.type.store(static_cast<std::uint32_t>(type), std::memory_order_release);
        s.link.store(link ? link->value : no_link, std::memory_order_release);
        store_text(s.label, label);
    });
    return reinterpret_cast<Counter*>(&slot.value);
}

void CounterPage::remove(Counter* counter) noexcept {
    if (counter == nullptr) return;
    CounterSlot* const slots = counters_in(*segment_);
    const auto distance = reinterpret_cast<std::uint8_t*>(counter) - reinterpret_cast<std::uint8_t*>(slots);
    const auto index = static_cast<std::uint32_t>(static_cast<std::size_t>(distance) / sizeof(CounterSlot));
    assert(distance >= 0 && index < slots_ && counter == reinterpret_cast<Counter*>(&slots[index].value));
    if (slots[index].type.load(std::memory_order_relaxed) == 0) return;  // removed already
    change(slots[index], [](CounterSlot& slot) { slot.type.store(0, std::memory_order_release); });
    assert(free_counters_.size() < slots_);
    free_counters_.push_back(index);
}

bool CounterPage::name_link(LinkId link, std::string_view name, std::string_view sends_to) {
    auto known = links_.find(link);
    if (known == links_.end()) {
        const auto index = take_last(free_links_);
        if (!index) return false;
        known = links_.emplace(link, *index).first;
    }
    const auto text = text_of_link(name, sends_to);
    change(links_in(*segment_, slots_)[known->second], [&](LinkSlot& slot) {
        slot.link.store(link.value, std::memory_order_release);
        store_text(slot.name, text);
        slot.used.store(1, std::memory_order_release);
    });
    return true;
}

void CounterPage::forget_link(LinkId link) {
    const auto known = links_.find(link);
    if (known == links_.end()) return;
    change(links_in(*segment_, slots_)[known->second],
           [](LinkSlot& slot) { slot.used.store(0, std::memory_order_release); });
    assert(std::ranges::find(free_links_, known->second) == free_links_.end());
    free_links_.push_back(known->second);
    links_.erase(known);
}

void remove_left_page(std::string_view ring) {
    auto page = Segment::open(path_of(ring, page_suffix), Segment::Access::read_write, 0, check_owner);
    if (page && page->try_lock(owner_byte)) static_cast<void>(page->unlink());
}

bool CounterPage::is_removed() const noexcept { return !segment_->is_named(); }

SetupResult<CounterSnapshot> read_counters(std::string_view name, const Trust& trust) {
    if (auto good = check_name(name); !good) return tl::unexpected(std::move(good.error()));
    const auto check = [&](const Segment& file) {
        return check_trusted(file, fmt::format("the counter page of {}", name), trust);
    };
    const auto segment = Segment::open(path_of(name, page_suffix), Segment::Access::read_only, page_header_bytes, check);
    if (!segment) return tl::unexpected(segment.error());
    const auto header = header_of(*segment);
    if (!header) return tl::unexpected(header.error());
    const auto* const counters = counters_in(*segment);
    const auto* const links = links_in(*segment, header->counters);
    CounterSnapshot snapshot;
    snapshot.owner_alive = segment->is_locked(owner_byte);
    snapshot.owner_pid = header->pid;
    snapshot.started = WallTime{Nanoseconds{header->started_ns}};
    for (std::uint32_t i = 0; i < header->counters; ++i)
        if (auto value = read_slot(counters[i], value_in); value && *value)
            snapshot.counters.push_back(std::move(**value));
    for (std::uint32_t i = 0; i < header->links; ++i)
        if (auto read = read_slot(links[i], link_in); read && *read) {
            auto& link = **read;
            if (!link.sends_to.empty()) snapshot.sends_to.emplace(link.id, std::move(link.sends_to));
            snapshot.links.emplace(link.id, std::move(link.name));
        }
    return snapshot;
}

}  // namespace mavloom::shm
