// SPDX-License-Identifier: MIT
#include "sim/metadata/metadata.hpp"

#include <array>
#include <map>
#include <mutex>
#include <vector>

#include "flight/firmware/firmware.hpp"
#include "mavloom/wire/crc32.hpp"
#include "sim/metadata/documents.hpp"
#include "sim/metadata/xz.hpp"

namespace mavloom::sim {

namespace {

// PX4's paths.
constexpr std::array<std::string_view, 4> paths{"etc/extras/component_general.json.xz", "etc/extras/parameters.json.xz",
                                                "etc/extras/all_events.json.xz", "etc/extras/actuators.json.xz"};
constexpr std::string_view general_uri = "mftp://etc/extras/component_general.json.xz";

ByteView bytes_of(std::string_view text) noexcept {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

struct MetadataFiles {
    explicit MetadataFiles(const Firmware& firmware) {
        files[1] = compress_xz(parameter_document(firmware));
        files[2] = compress_xz(event_document(firmware));
        files[3] = compress_xz(actuator_document(firmware));
        const auto listed = [&](MetadataType type, std::size_t i) {
            return ListedMetadata{type, paths[i], wire::crc32(0, files[i])};
        };
        const std::array list{listed(MetadataType::parameter, 1), listed(MetadataType::events, 2),
                              listed(MetadataType::actuators, 3)};
        const std::string general_text = general_document(list);
        general_crc = wire::crc32(0, bytes_of(general_text));
        files[0] = compress_xz(general_text);
    }

    std::array<std::vector<std::uint8_t>, paths.size()> files;  // as `paths`
    std::uint32_t general_crc = 0;
};

// The files of a firmware, made at the first call for it. A Firmware lives as long as the program.
const MetadataFiles& files_of(const Firmware& firmware) {
    static std::mutex mutex;
    static std::map<const Firmware*, MetadataFiles> made;
    const std::scoped_lock lock(mutex);
    const auto at = made.find(&firmware);
    return at != made.end() ? at->second : made.try_emplace(&firmware, firmware).first->second;
}

}  // namespace

std::optional<GeneralMetadata> general_metadata(const Firmware& firmware) {
    if (!firmware.is_px4()) return std::nullopt;
    return GeneralMetadata{general_uri, files_of(firmware).general_crc};
}

std::span<const std::string_view> metadata_paths(const Firmware& firmware) noexcept {
    return firmware.is_px4() ? std::span<const std::string_view>(paths) : std::span<const std::string_view>{};
}

ByteView metadata_file(const Firmware& firmware, std::size_t index) {
    if (index >= metadata_paths(firmware).size()) return {};
    return files_of(firmware).files[index];
}

}  // namespace mavloom::sim
