// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "command.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::app {

static Exit create_key(const Common& common, const std::string& file) {
    const auto key = wire::SigningKey::random();
    if (!key) return fail(key.error());
    if (const auto created = key->create_file(file); !created) return fail(created.error());
    print_notice(common, fmt::format("{}: new key; anyone who has this file can sign, so keep it secret", file));
    return Exit::done;
}

Run declare_key(Arguments command, const Common& common) {
    auto file = std::make_shared<std::string>();
    auto create = command.add_subcommand("new", "write a new random signing key to a file of mode 0600");
    create.add_option("file", "FILE", *file, "the file to create").required();
    create.fallthrough();
    create.footer("Example: mavloom key new link.key");
    command.require_subcommand();
    command.footer(
        "Keys sign and verify MAVLink 2 frames: with sign=FILE and verify=FILE of an endpoint, or with relay --sign "
        "FILE.\n\n"
        "Example: mavloom key new link.key");
    return [file, &common] { return create_key(common, *file); };
}

}  // namespace mavloom::app
