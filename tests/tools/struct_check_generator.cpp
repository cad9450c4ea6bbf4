// SPDX-License-Identifier: MIT
// Writes one test source for a share of the built-in messages: struct_check_generator OUT.cpp SHARE OF_SHARES.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "dialectgen/output.hpp"
#include "mavloom/dialect/dialect.hpp"

int main(int argc, char** argv) {
    using namespace mavloom;
    if (argc != 4) return 2;
    const auto share = std::strtoul(argv[2], nullptr, 10), shares = std::strtoul(argv[3], nullptr, 10);
    std::string includes, checks;
    const auto messages = dialect::default_dialect().messages();
    for (std::size_t i = share; i < messages.size(); i += shares) {
        const auto name = dialectgen::pascal_case(messages[i].name);
        includes += fmt::format("#include \"mavloom/msg/{}.hpp\"\n", dialectgen::lower_case(messages[i].name));
        checks += fmt::format(
            "    check_struct(facts_of<msg::{0}>([](ByteView payload, StructCheck& check, ByteSpan encoded) {{\n"
            "        const auto s = msg::{0}::decode(payload);\n",
            name);
        for (const auto& field : messages[i].fields)
            checks += fmt::format("        check.member(\"{}\", s.{});\n", field.name,
                                  dialectgen::safe_member(field.name, name));
        checks += "        s.encode(encoded);\n    }));\n";
    }
    std::ofstream out(argv[1]);
    out << "#include \"tools/struct_check.hpp\"\n"
        << includes << "\nnamespace mavloom::test {\n\nTEST(GeneratedStructs, AgreeWithMessageViewShare" << share
        << ") {\n"
        << checks << "}\n\n}  // namespace mavloom::test\n";
    return out.flush() ? 0 : 1;
}
