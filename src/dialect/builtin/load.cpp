// SPDX-License-Identifier: MIT
// Dialect::load, which takes public files that are not on the disk from the binary. Separate from the reader, which the
// generator of those files uses too.
#include "dialect/core/loader.hpp"

namespace mavloom::dialect {

SetupResult<Dialect> Dialect::load(const std::filesystem::path& xml) {
    auto storage = std::make_shared<Storage>();
    auto definitions = read_with_includes(xml, builtin_files(), *storage);
    if (!definitions) return tl::unexpected(std::move(definitions.error()));
    if (auto merged = merge(std::move(*definitions), *storage); !merged)
        return tl::unexpected(std::move(merged.error()));
    const auto name = storage->intern(xml.stem().string());
    return Dialect(name, std::move(storage));
}

}  // namespace mavloom::dialect
