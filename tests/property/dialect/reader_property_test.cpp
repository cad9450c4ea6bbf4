// SPDX-License-Identifier: MIT
// What holds for all definitions: the layout rules of the MAVLink guide, and that it does not matter how definitions
// are spread over files.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/seed.hpp"
#include "unit/dialect/xml_folder.hpp"

namespace mavloom::dialect::test {
namespace {

struct Drawn {
    std::string type;
    std::size_t length;  // 0: a scalar
};

const std::vector<std::string> types{"char",    "uint8_t",  "int8_t",  "uint16_t", "int16_t", "uint32_t",
                                     "int32_t", "uint64_t", "int64_t", "float",    "double"};

std::vector<Drawn> draw_fields() {
    const auto count = *rc::gen::inRange<std::size_t>(1, 12);
    std::vector<Drawn> fields;
    for (std::size_t i = 0; i < count; ++i)
        fields.push_back({*rc::gen::elementOf(types),
                          *rc::gen::weightedOneOf<std::size_t>(
                              {{3, rc::gen::just<std::size_t>(0)}, {1, rc::gen::inRange<std::size_t>(1, 3)}})});
    return fields;
}

std::string message_text(int id, const std::vector<Drawn>& fields, std::size_t first_extension) {
    auto text = "<message id=\"" + std::to_string(id) + "\" name=\"M" + std::to_string(id) + "\">";
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (i == first_extension) text += "<extensions/>";
        const auto array = fields[i].length == 0 ? "" : "[" + std::to_string(fields[i].length) + "]";
        text += "<field type=\"" + fields[i].type + array + "\" name=\"f" + std::to_string(i) + "\"/>";
    }
    return text + "</message>";
}

// (offset, size of one element, index) of the base fields and of the extension fields, by offset.
struct Placed {
    std::size_t offset, type_size, size, index;
};
std::vector<Placed> placed(const Message& message, bool extension) {
    std::vector<Placed> out;
    for (std::size_t i = 0; i < message.fields.size(); ++i) {
        const auto& f = message.fields[i];
        if (f.extension == extension) out.push_back({f.offset, size_of(f.type), f.size(), i});
    }
    std::ranges::sort(out, {}, &Placed::offset);
    return out;
}

RC_GTEST_PROP(ReaderProperty, LayoutFollowsTheGuide, ()) {
    const auto fields = draw_fields();
    const auto first_extension = *rc::gen::inRange<std::size_t>(0, fields.size() + 1);
    const XmlFolder folder;
    folder.write("a.xml", messages(message_text(1, fields, first_extension)));
    const auto loaded = folder.load();
    RC_ASSERT(loaded.has_value());
    const auto& message = loaded->messages()[0];
    std::size_t end = 0;
    const auto base = placed(message, false);
    for (std::size_t i = 0; i < base.size(); ++i) {
        RC_ASSERT(base[i].offset == end);
        end += base[i].size;
        if (i == 0) continue;
        const bool falls = base[i - 1].type_size > base[i].type_size;
        RC_ASSERT(falls || (base[i - 1].type_size == base[i].type_size && base[i - 1].index < base[i].index));
    }
    RC_ASSERT(message.wire.min_length == end);
    const auto extension = placed(message, true);
    for (std::size_t i = 0; i < extension.size(); ++i) {
        RC_ASSERT(extension[i].offset == end);
        RC_ASSERT(extension[i].index == first_extension + i);
        end += extension[i].size;
    }
    RC_ASSERT(message.wire.max_length == end);
}

RC_GTEST_PROP(ReaderProperty, ExtensionsChangeNeitherChecksumNorBase, ()) {
    const auto fields = draw_fields();
    auto longer = fields;
    longer.push_back({*rc::gen::elementOf(types), 0});
    const XmlFolder folder;
    folder.write("a.xml", messages(message_text(1, fields, fields.size())));
    folder.write("b.xml", messages(message_text(1, longer, fields.size())));
    const auto a = folder.load("a.xml"), b = folder.load("b.xml");
    RC_ASSERT(a.has_value() && b.has_value());
    RC_ASSERT(a->messages()[0].wire.crc_extra == b->messages()[0].wire.crc_extra);
    RC_ASSERT(a->messages()[0].wire.min_length == b->messages()[0].wire.min_length);
}

RC_GTEST_PROP(ReaderProperty, SpreadOverFilesMeansTheSame, ()) {
    const auto count = *rc::gen::inRange(1, 8);
    std::string together;
    std::vector<std::string> files(4);
    for (int id = 0; id < count; ++id) {
        const auto text = message_text(id, draw_fields(), 99);
        together += text;
        files[*rc::gen::inRange<std::size_t>(0, files.size())] += text;
    }
    const XmlFolder folder;
    folder.write("all.xml", messages(together));
    for (std::size_t i = 0; i < files.size(); ++i) {  // each includes the next, the last the first
        const auto next = std::to_string((i + 1) % files.size());
        folder.write(std::to_string(i) + ".xml",
                     "<mavlink><include>" + next + ".xml</include><messages>" + files[i] + "</messages></mavlink>");
    }
    const auto one = folder.load("all.xml"), several = folder.load("0.xml");
    RC_ASSERT(one.has_value() && several.has_value());
    RC_ASSERT(one->messages().size() == several->messages().size());
    for (std::size_t i = 0; i < one->messages().size(); ++i) {
        RC_ASSERT(one->messages()[i].name == several->messages()[i].name);
        RC_ASSERT(one->messages()[i].wire == several->messages()[i].wire);
    }
}

// Whatever bytes a file has, it is read or refused with a text that names it.
RC_GTEST_PROP(ReaderProperty, DamagedFileIsReadOrRefused, (const std::vector<std::pair<std::uint16_t, char>>& changes)) {
    auto text = messages(message_text(1, {{"float", 0}, {"char", 2}, {"uint8_t", 0}}, 2));
    for (const auto& [at, byte] : changes) text[at % text.size()] = byte;
    const XmlFolder folder;
    folder.write("a.xml", text);
    const auto loaded = folder.load();
    const bool names_file = !loaded && loaded.error().text.find("a.xml") !=
                                           std::string::npos;  // RC_ASSERT evaluates both sides of ||
    RC_ASSERT(loaded.has_value() != names_file);
}

}  // namespace
}  // namespace mavloom::dialect::test
