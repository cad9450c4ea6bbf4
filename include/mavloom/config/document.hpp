// SPDX-License-Identifier: MIT
// A TOML file as tables of text: the form from which configurations and scenarios are read.
//
// Each value keeps its line number, so that errors can state it. Plain values; parsing allocates. Errors are
// `bad_input` and begin with FILE:LINE:.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/config/config.hpp"

namespace mavloom::config {

struct Entry {
    std::string key;
    // The value in the syntax of endpoint options: a scalar as text, an array as A,B, a table as KEY:VALUE,KEY:VALUE.
    // Empty: the value is of a type that has no such text, for example a date.
    std::optional<std::string> text;
    std::uint32_t line = 0;
    std::vector<Entry> entries{};  // the entries of a table, in the order of the file
};

struct Table {
    enum class Form : std::uint8_t { table, one_of_list, other };

    std::string name;
    // `one_of_list`: written [[name]]. `other`: not a table but a value, for example `name = 5`.
    Form form = Form::table;
    std::uint32_t line = 0;
    std::vector<Entry> entries{};  // in the order of the file

    [[nodiscard]] const Entry* find(std::string_view key) const noexcept;
};

struct Document {
    std::string file;           // its name, for errors
    std::vector<Table> tables;  // in the order of the file

    // Null if there is none. For a list: its first table.
    [[nodiscard]] const Table* find(std::string_view name) const noexcept;
    [[nodiscard]] tl::unexpected<SetupError> error(std::uint32_t line, std::string_view what) const;
    // Refuses tables that are not in `sections` or `lists`, and those that are written in the wrong form.
    [[nodiscard]] SetupResult<void> check_tables(std::span<const std::string_view> sections,
                                                 std::span<const std::string_view> lists) const;
    // Refuses keys that are not in `known`.
    [[nodiscard]] SetupResult<void> check_keys(const Table& table, std::span<const std::string_view> known) const;
    // The value of an entry as text.
    [[nodiscard]] SetupResult<std::string> text_of(const Entry& entry) const;
};

[[nodiscard]] SetupResult<Document> parse_document(std::string_view text, std::string_view file_name);
[[nodiscard]] SetupResult<Document> load_document(const std::filesystem::path& file);

// Reads a router's configuration, as `load_config` does.
[[nodiscard]] SetupResult<Config> read_config(const Document& document, const Environment& environment = {},
                                              Overrides overrides = {});

// Finds variables that set a key of one of the sections: MAVLOOM_SECTION_KEY.
class Variables {
public:
    struct Name {
        std::string_view section, key;
    };
    Variables(const Environment& environment, std::vector<Name> known)
        : environment_(environment), known_(std::move(known)) {}

    // A variable that sets no key is an error if its name resembles that of a key, or if MAVLOOM_ is followed by a
    // section's name. Otherwise it only adds a note.
    [[nodiscard]] SetupResult<void> check(std::vector<std::string>& notes) const;
    [[nodiscard]] static std::string name_of(const Name& name);
    // Null if the variable is not set.
    [[nodiscard]] const std::string* find(const Name& name) const;

private:
    [[nodiscard]] bool is_of_a_section(std::string_view variable) const;

    const Environment& environment_;
    std::vector<Name> known_;
};

struct PlacedEndpoint {
    endpoint::Endpoint endpoint;
    Section section;  // all options as text, with their origins
};
// Reads an [[endpoint]] table. It gives the place as `url`, or as `scheme` with `host` and `port`, `path` or `ring`.
// The options of the scheme are further keys. Refuses an endpoint that has the same name as one of the `earlier`
// sections.
[[nodiscard]] SetupResult<PlacedEndpoint> read_endpoint(const Document& document, const Table& table,
                                                        std::span<const Section> earlier);

}  // namespace mavloom::config
