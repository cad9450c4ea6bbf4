// SPDX-License-Identifier: MIT
// mavloom_dialectgen: generates C++ from a MAVLink XML file. mavloom_add_dialect() runs it
// (cmake/MavloomDialect.cmake).
#include <cerrno>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dialect/core/loader.hpp"
#include "generate.hpp"
#include "public_folder.hpp"

namespace {

using namespace mavloom;

constexpr std::string_view usage =
    "usage: mavloom_dialectgen FILE.xml --out DIR --namespace NS [--public DIR] [--part tables|headers] [--stamp FILE] "
    "[--builtin] [--lean]\n";

struct Arguments {
    std::string xml, part, stamp;
    std::string public_folder;  // of public definitions, for includes
    bool is_lean = false;       // tables without what a router does not need
    dialectgen::Options options;
};

std::optional<Arguments> parse(int argc, char** argv) {
    Arguments arguments;
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        const bool has_value = i + 1 < argc;
        if (word == "--builtin") {
            arguments.options.is_builtin = true;
        } else if (word == "--lean") {
            arguments.is_lean = true;
        } else if (word == "--out" && has_value) {
            arguments.options.out = argv[++i];
        } else if (word == "--namespace" && has_value) {
            arguments.options.cpp_namespace = argv[++i];
        } else if (word == "--public" && has_value) {
            arguments.public_folder = argv[++i];
        } else if (word == "--part" && has_value) {
            arguments.part = argv[++i];
        } else if (word == "--stamp" && has_value) {
            arguments.stamp = argv[++i];
        } else if (!word.starts_with("-") && arguments.xml.empty()) {
            arguments.xml = word;
        } else {
            return std::nullopt;
        }
    }
    if (arguments.xml.empty() || arguments.options.out.empty() || arguments.options.cpp_namespace.empty())
        return std::nullopt;
    arguments.options.source = std::filesystem::path(arguments.xml).filename().string();
    return arguments;
}

SetupResult<void> touch(const std::string& stamp) {
    if (stamp.empty()) return {};
    std::FILE* file = std::fopen(stamp.c_str(), "wb");
    if (file == nullptr || std::fclose(file) != 0) return system_error("cannot write " + stamp, errno);
    return {};
}

// Leaves the messages with their layouts, and the fields that distinguish instances.
void make_lean(dialect::Records& records) {
    for (auto& message : records.messages) {
        std::vector<dialect::Field> instances;
        for (dialect::Field field : message.fields) {
            if (!field.instance) continue;
            field.units = field.invalid = {};
            field.enumeration = nullptr;
            instances.push_back(field);
        }
        message.fields = dialect::Records::keep(records.fields, std::move(instances));
    }
    records.enums.clear();
}

SetupResult<void> generate(const Arguments& arguments) {
    const auto folder = dialectgen::PublicFolder::read(arguments.public_folder);
    if (!folder) return tl::unexpected(folder.error());
    const bool is_lean = arguments.is_lean && arguments.part == "tables";
    dialect::Records records;
    auto definitions = dialect::read_with_includes(arguments.xml, folder->files(), records);
    if (!definitions) return tl::unexpected(std::move(definitions.error()));
    if (auto merged = dialect::merge(std::move(*definitions), records); !merged) return merged;
    if (is_lean) make_lean(records);
    const auto name = std::filesystem::path(arguments.xml).stem().string();
    const dialect::Dialect loaded(name, records.messages, records.enums);
    if (arguments.part != "headers")
        if (auto written = dialectgen::write_tables(loaded, arguments.options); !written) return written;
    if (arguments.part != "headers" && arguments.options.is_builtin)
        if (auto written = dialectgen::write_files(is_lean ? dialectgen::PublicFolder() : *folder, arguments.options);
            !written)
            return written;
    if (arguments.part != "tables")
        if (auto written = dialectgen::write_headers(loaded, arguments.options); !written) return written;
    return touch(arguments.stamp);
}

}  // namespace

int main(int argc, char** argv) {
    const auto arguments = parse(argc, argv);
    if (!arguments) {
        (void)std::fputs(usage.data(), stderr);
        return 2;
    }
    if (const auto done = generate(*arguments); !done) {
        (void)std::fprintf(stderr, "mavloom_dialectgen: %s\n", done.error().text.c_str());
        return done.error().code == SetupCode::bad_input || done.error().code == SetupCode::not_found ? 3 : 1;
    }
    return 0;
}
