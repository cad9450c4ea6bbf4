// SPDX-License-Identifier: MIT
#include "mavutil/log.hpp"

#include <nanobind/stl/pair.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>

#include "bindings.hpp"
#include "errors.hpp"
#include "gil.hpp"
#include "mavloom/message/instance.hpp"
#include "strings.hpp"

namespace mavloom::python {

// ---- types

namespace {

// The id in "UNKNOWN_<id>", the name of a message without definition.
std::optional<MessageId> unknown_id(std::string_view name) noexcept {
    constexpr std::string_view beginning = "UNKNOWN_";
    if (!name.starts_with(beginning)) return std::nullopt;
    const auto digits = name.substr(beginning.size());
    std::uint32_t id = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), id);
    if (error != std::errc{} || end != digits.data() + digits.size() || id > 0xff'ff'ff) return std::nullopt;
    return MessageId{id};
}

}  // namespace

MavutilTypes::MavutilTypes(const PyDialect& dialect, const nb::iterable& names) {
    const auto& definitions = dialect.definitions->dialect();
    for (const nb::handle name : names) {
        if (!nb::isinstance<nb::str>(name)) {
            PyErr_Format(PyExc_TypeError, "type= takes names of messages, not %R", name.ptr());
            throw nb::python_error();
        }
        const std::string text = nb::cast<std::string>(name);
        bad_data_ = bad_data_ || text == "BAD_DATA";
        if (const auto* message = definitions.find(text)) ids_.push_back(message->id());
        else if (const auto id = unknown_id(text)) unknown_.push_back(*id);
    }
}

bool MavutilTypes::takes(const MavutilMessage& message) const noexcept {
    if (message.base.size == 0) return bad_data_;
    const auto& ids = message.base.definition == nullptr ? unknown_ : ids_;
    return std::ranges::find(ids, message.base.frame().id()) != ids.end();
}

// ---- reading

namespace {

constexpr std::size_t batch_entries = 512;
constexpr std::uint64_t max_damage = 1 << 20;      // bytes to read before signals are handled
constexpr std::size_t damage_at_once = 64 * 1024;  // bytes of a damaged place that are examined together
constexpr std::size_t longest_damage = 4096;       // bytes of one BAD_DATA message

}  // namespace

MavutilLog::MavutilLog(std::string path, const nb::object& dialect, nb::object bad_data, nb::object state)
    : path_(std::move(path)),
      origin_(std::make_shared<Origin>(dialect)),
      bad_data_(std::move(bad_data)),
      state_object_(std::move(state)),
      state_(nb::cast<MavutilState&>(state_object_)),
      reader_(value_or_raise(open())),
      size_(reader_->size()) {
    origin_->link_names().add(LinkId{0}, "tlog://" + path_);
}

SetupResult<record::TlogReader> MavutilLog::open() const {
    const WithoutGil outside;
    return record::TlogReader::open(path_, origin_->dialect().wire_table());
}

record::TlogReader& MavutilLog::reader() {
    if (!reader_) raise_closed(path_ + ": the recording is closed");
    return *reader_;
}

nb::object MavutilLog::next() {
    for (;; check_signals()) {
        const auto lock = lock_without_gil(mutex_);
        static_cast<void>(reader());  // raises if closed
        if (next_ < entries_.size()) {
            const auto& entry = entries_[next_++];
            place_ = entry.place;
            ++packets_;
            packet_bytes_ += entry.size;
            damaged_ += entry.damage.empty() ? 0 : 1;
            return message_of(entry);
        }
        if (ended_ && !has_grown()) {
            place_ = size_;
            return {};
        }
        const WithoutGil outside;
        if (!fill()) break;
    }
    raise(reader().error());
}

// Whether another program has appended to the file since its end was reached. If so, reading continues.
bool MavutilLog::has_grown() {
    std::error_code failed;
    const auto size = std::filesystem::file_size(path_, failed);
    if (failed || size <= size_ || !reader_->seek(end_)) return false;
    size_ = size;
    ended_ = false;
    return true;
}

// Reads the next batch. Returns false if reading failed.
bool MavutilLog::fill() {
    using Stop = record::TlogReader::Stop;
    entries_.clear();
    bytes_.clear();
    next_ = 0;
    while (entries_.size() < batch_entries) {
        const auto record = reader_->next(max_damage);
        if (record) {
            add(*record);
            continue;
        }
        if (record.error() == Stop::failed) return !entries_.empty();
        ended_ = record.error() == Stop::end;
        if (ended_ && end_ < reader_->position()) add_damage(end_, reader_->position() - end_);
        if (!entries_.empty() && !entries_.back().damage.empty()) end_ = reader_->position();  // returned once
        break;
    }
    return true;
}

void MavutilLog::add(const record::Record& record) {
    if (record.lost_bytes != 0) add_damage(record.offset - record.lost_bytes, record.lost_bytes);
    time_ns_ = record.time.time_since_epoch().count();
    end_ = record.offset + record::time_length + record.frame.size();
    const auto* definition = record.info == nullptr ? nullptr : origin_->dialect().find(record.frame.id());
    add_entry({.time_ns = time_ns_,
               .definition = definition,
               .place = record.offset,
               .link = static_cast<std::uint32_t>(time_ns_ / 1000 & 3)},
              record.frame.bytes());
}

void MavutilLog::add_entry(Entry entry, ByteView bytes) {
    entry.begin = static_cast<std::uint32_t>(bytes_.size());
    entry.size = static_cast<std::uint16_t>(bytes.size());
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    entries_.push_back(std::move(entry));
}

// Adds what a damaged place of the file holds: frames with a wrong checksum behind their time, and bytes that begin no
// frame. A record that the end of the file cuts off is not reported.
void MavutilLog::add_damage(std::uint64_t from, std::uint64_t count) {
    auto file = record::File::open_to_read(path_);
    if (!file || !file->seek(from)) return;
    std::vector<std::uint8_t> bytes(std::min<std::uint64_t>(count, damage_at_once));
    const auto got = file->read(bytes).value_or(0);
    ByteView left(bytes.data(), std::min<std::uint64_t>(got, count));
    while (!left.empty()) {
        const auto used = add_damaged_frame(left, from);
        from += used;
        left = left.subspan(used);
    }
}

// Returns the number of bytes that it used.
std::size_t MavutilLog::add_damaged_frame(ByteView bytes, std::uint64_t place) {
    const auto behind_time = bytes.subspan(std::min(bytes.size(), record::time_length));
    const auto length = wire::frame_length(behind_time);
    if (length > behind_time.size() && ended_) return bytes.size();
    Entry entry{.time_ns = time_ns_, .place = place, .damage = bad_prefix};
    if (length == 0 || length > behind_time.size()) {
        const auto part = bytes.first(std::min(bytes.size(), longest_damage));
        add_entry(std::move(entry), part);
        return part.size();
    }
    const auto frame = wire::FrameView::unchecked(behind_time.first(length));
    entry.damage = crc_reason(frame, origin_->dialect().find(frame.id()));
    const auto time_us = load_be64(bytes.data());
    if (time_us < record::time_limit_us) entry.time_ns = static_cast<std::int64_t>(time_us) * 1000;
    add_entry(std::move(entry), frame.bytes());
    return record::time_length + length;
}

nb::object MavutilLog::message_of(const Entry& entry) const {
    const ByteView bytes(bytes_.data() + entry.begin, entry.size);
    if (entry.damage.empty())
        return make_mavutil_message(origin_, entry.definition, entry.time_ns, entry.link,
                                    wire::FrameView::unchecked(bytes), 0);
    nb::object made = bad_data_(bytes_of(bytes), entry.damage);
    if (auto* message = mavutil_message(made)) message->base.time_ns = entry.time_ns;
    return made;
}

nb::object MavutilLog::match(const nb::object& owner, const MavutilTypes* types) {
    for (;;) {
        nb::object message = next();
        if (!message.is_valid()) return nb::none();
        if (state_.note(message).value_or(false)) owner.attr("_notice")(message);
        if (types == nullptr || types->takes(*mavutil_message(message))) return message;
    }
}

// ---- the index

namespace {

// Counts the messages of a recording by type. Keeps the first one of each type, and of each further instance.
class Index {
public:
    struct First {
        const dialect::Message* definition;
        std::int64_t time_ns;
        std::vector<std::uint8_t> frame;
        bool is_instance;
    };

    explicit Index(const dialect::Dialect& dialect) : dialect_(dialect) {}

    void add(const record::Record& record) {
        if (record.info == nullptr) return;
        const auto* definition = dialect_.find(record.frame.id());
        const bool is_first = counts[definition]++ == 0;
        if (is_first) order.push_back(definition);
        if (!is_new_instance(*definition, record.frame) && !is_first) return;
        const auto bytes = record.frame.bytes();
        firsts.push_back({definition, record.time.time_since_epoch().count(), {bytes.begin(), bytes.end()}, !is_first});
    }

    std::vector<First> firsts;
    std::vector<const dialect::Message*> order;  // of their first occurrence
    std::map<const dialect::Message*, std::uint64_t> counts;

private:
    static constexpr std::size_t max_instances = 4096;

    bool is_new_instance(const dialect::Message& definition, const wire::FrameView& frame) {
        const auto* field = message::instance_field(definition);
        return field != nullptr && instances_.size() < max_instances &&
               instances_.emplace(&definition, message::instance_of(definition, *field, frame.payload())).second;
    }

    const dialect::Dialect& dialect_;
    std::set<std::pair<const dialect::Message*, message::Instance>> instances_;
};

int percent_of(const record::TlogReader& file) {
    return file.size() == 0 ? 100 : static_cast<int>(100 * file.position() / file.size());
}

// Reads until signals must be handled or `percent` of the file are passed. Returns false at the end.
bool add_some(record::TlogReader& file, Index& index, int percent) {
    using Stop = record::TlogReader::Stop;
    const WithoutGil outside;
    for (std::size_t read = 0; read < 65'536 && percent_of(file) <= percent; ++read) {
        const auto record = file.next(max_damage);
        if (record) index.add(*record);
        else if (record.error() != Stop::damage) return false;
    }
    return true;
}

// Reads the whole file. Calls `progress` with each percentage that is reached.
void add_all(record::TlogReader& file, Index& index, const nb::object& progress) {
    int percent = 0;
    for (bool more = true; more; check_signals()) {
        more = add_some(file, index, progress.is_none() ? 100 : percent);
        const int reached = more ? percent_of(file) : 100;
        if (!progress.is_none() && reached > percent) progress(reached);
        percent = std::max(percent, reached);
    }
}

}  // namespace

nb::dict MavutilLog::index(const nb::object& owner, const nb::object& progress) {
    Index index(origin_->dialect());
    auto file = value_or_raise(open());
    add_all(file, index, progress);
    for (const auto& first : index.firsts) {
        const nb::object message = make_mavutil_message(origin_, first.definition, first.time_ns, 0,
                                                        wire::FrameView::unchecked(first.frame), 0);
        if (!first.is_instance && state_.note(message).value_or(false)) owner.attr("_notice")(message);
        state_.add_to_target(message);
    }
    nb::dict names;
    for (const auto* definition : index.order)
        names[origin_->definitions()->names(*definition).message] = index.counts[definition];
    return names;
}

// ---- state

void MavutilLog::rewind() {
    const auto lock = lock_without_gil(mutex_);
    value_or_raise(reader().seek(0));
    entries_.clear();
    next_ = 0;
    place_ = end_ = 0;
    ended_ = false;
}

double MavutilLog::percent() {
    const auto lock = lock_without_gil(mutex_);
    return size_ == 0 ? 0 : 100.0 * static_cast<double>(place_) / static_cast<double>(size_);
}

std::pair<std::uint64_t, std::uint64_t> MavutilLog::totals() {
    const auto lock = lock_without_gil(mutex_);
    return {packets_, packet_bytes_};
}

std::uint64_t MavutilLog::damaged() {
    const auto lock = lock_without_gil(mutex_);
    return damaged_;
}

void MavutilLog::close() {
    const auto lock = lock_without_gil(mutex_);
    reader_.reset();
}

void bind_mavutil_log(nb::module_& module) {
    nb::class_<MavutilTypes>(module, "MavutilTypes", nb::is_final(), "The names of messages that a call selects.")
        .def(nb::init<const PyDialect&, const nb::iterable&>(), nb::arg("dialect"), nb::arg("names"),
             nb::sig("def __init__(self, dialect: Dialect, names: collections.abc.Iterable[str]) -> None"))
        .def("takes",
             [](const MavutilTypes& types, nb::handle message) {
                 const auto* given = mavutil_message(message);
                 return given != nullptr && types.takes(*given);
             })
        .def_prop_ro("has_any", &MavutilTypes::has_any);

    nb::class_<MavutilLog>(module, "MavutilLog", nb::is_final(), "Reads a recording for mavloom.mavutil.")
        .def(
            "__init__",
            [](MavutilLog* self, const nb::object& path, const nb::object& dialect, nb::object bad_data,
               nb::object state) {
                new (self) MavutilLog(path_of(path), dialect, std::move(bad_data), std::move(state));
            },
            nb::arg("path"), nb::arg("dialect"), nb::arg("bad_data"), nb::arg("state"),
            nb::sig("def __init__(self, path: str | os.PathLike[str], dialect: Dialect, bad_data: "
                    "collections.abc.Callable[[bytes, str], MavutilMessage], state: MavutilState) -> None"))
        .def("index", &MavutilLog::index, nb::arg("owner"), nb::arg("progress").none(),
             nb::sig("def index(self, owner: typing.Any, "
                     "progress: collections.abc.Callable[[int], object] | None) -> dict[str, int]"))
        .def("match", &MavutilLog::match, nb::arg("owner"), nb::arg("types").none(),
             nb::sig("def match(self, owner: typing.Any, types: MavutilTypes | None) -> typing.Any"))
        .def(
            "next",
            [](MavutilLog& log) {
                nb::object message = log.next();
                return message.is_valid() ? message : nb::none();
            },
            nb::sig("def next(self) -> typing.Any"))
        .def("rewind", &MavutilLog::rewind)
        .def_prop_ro("percent", &MavutilLog::percent)
        .def_prop_ro("totals", &MavutilLog::totals, nb::sig("def totals(self) -> tuple[int, int]"))
        .def_prop_ro("damaged", &MavutilLog::damaged)
        .def("close", &MavutilLog::close);
}

}  // namespace mavloom::python
