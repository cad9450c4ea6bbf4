// SPDX-License-Identifier: MIT
#include "sim/store/parameter_pack.hpp"

#include <algorithm>
#include <charconv>

#include "mavloom/base/bytes.hpp"

namespace mavloom::sim {

namespace {

constexpr std::uint16_t magic = 0x671b, magic_with_defaults = 0x671c;
constexpr std::uint8_t has_default = 1 << 4;  // beside the type

struct Query {
    bool with_defaults = false;
    std::uint16_t start = 0, count = 0xffff;
};

std::uint16_t number_of(std::string_view text) noexcept {
    std::uint16_t number = 0;
    (void)std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

Query query_of(std::string_view text) noexcept {
    Query query;
    while (!text.empty()) {
        const std::string_view term = text.substr(0, text.find('&'));
        text.remove_prefix(std::min(text.size(), term.size() + 1));
        const std::size_t sign = term.find('=');
        const std::string_view key = term.substr(0, sign);
        const std::uint16_t value = sign == std::string_view::npos ? 0 : number_of(term.substr(sign + 1));
        if (key == "withdefaults") query.with_defaults = value != 0;
        if (key == "start") query.start = value;
        if (key == "count") query.count = value;
    }
    return query;
}

class PackWriter {
public:
    explicit PackWriter(bool with_defaults) noexcept : with_defaults_(with_defaults) {}

    void begin(std::uint16_t count, std::uint16_t total) {
        put(with_defaults_ ? magic_with_defaults : magic);
        put(count);
        put(total);
    }
    // Type and flags, lengths, the part of the name that differs from the previous name, the value, and its default if
    // that is another.
    void add(const ParamInfo& info, double value) {
        constexpr std::size_t most = 15;  // fits into four bits
        const std::size_t longest = std::min({previous_.size(), info.name.size() - 1, most});
        std::size_t common = 0;
        while (common < longest && previous_[common] == info.name[common]) ++common;
        const std::string_view rest = info.name.substr(common);
        const bool differs = with_defaults_ && value != info.initial;
        put(static_cast<std::uint8_t>(type_of(info.type) | (differs ? has_default : 0)));
        put(static_cast<std::uint8_t>((rest.size() - 1) << 4 | common));
        bytes_.insert(bytes_.end(), rest.begin(), rest.end());
        put_value(info.type, value);
        if (differs) put_value(info.type, info.initial);
        previous_ = info.name;
    }
    [[nodiscard]] std::vector<std::uint8_t> take() { return std::move(bytes_); }

private:
    template <class T>
    void put(T value) {
        bytes_.resize(bytes_.size() + sizeof value);
        store_le(bytes_.data() + bytes_.size() - sizeof value, value);
    }
    void put_value(ParamType type, double value) {
        switch (type) {
            case ParamType::int8: return put(static_cast<std::int8_t>(value));
            case ParamType::int16: return put(static_cast<std::int16_t>(value));
            case ParamType::int32: return put(static_cast<std::int32_t>(value));
            case ParamType::real32: return put(static_cast<float>(value));
        }
    }
    // ArduPilot's numbers of types.
    static std::uint8_t type_of(ParamType type) noexcept {
        switch (type) {
            case ParamType::int8: return 1;
            case ParamType::int16: return 2;
            case ParamType::int32: return 3;
            case ParamType::real32: break;
        }
        return 4;
    }

    bool with_defaults_;
    std::string_view previous_{};
    std::vector<std::uint8_t> bytes_;
};

}  // namespace

std::optional<std::vector<std::uint8_t>> parameter_pack(const Parameters& parameters, std::string_view path) {
    constexpr std::string_view name = "@PARAM/param.pck";
    const std::size_t mark = path.find('?');
    if (path.substr(0, mark) != name) return std::nullopt;
    const Query query = mark == std::string_view::npos ? Query{} : query_of(path.substr(mark + 1));
    const ParamIndex total = parameters.size(), start = std::min(query.start, total);
    const auto count = std::min<ParamIndex>(query.count, static_cast<ParamIndex>(total - start));
    PackWriter packer(query.with_defaults);
    packer.begin(count, total);
    for (ParamIndex i = start; i < start + count; ++i) packer.add(parameters.info(i), parameters.value(i));
    return packer.take();
}

}  // namespace mavloom::sim
