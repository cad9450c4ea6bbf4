// SPDX-License-Identifier: MIT
// replay_main TARGET PATH...: the main of all fuzz targets in builds without a fuzzing engine. Runs TARGET on
// every file of the folders (or files) PATH, so that each input that once broke something is tried in every test run.
// Fails when there is no input at all: an empty corpus proves nothing.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

// CMake renames LLVMFuzzerTestOneInput of <what>_fuzz.cpp to fuzz_<what>, and writes one FUZZ_TARGET(<what>) for each.
#define FUZZ_TARGET(what) extern "C" int fuzz_##what(const std::uint8_t* data, std::size_t size);
#include "fuzz_targets.inc"
#undef FUZZ_TARGET

namespace {

namespace fs = std::filesystem;

struct Target {
    std::string_view name;
    int (*run)(const std::uint8_t* data, std::size_t size);
};

constexpr Target targets[] = {
#define FUZZ_TARGET(what) {#what, fuzz_##what},
#include "fuzz_targets.inc"
};

std::vector<fs::path> inputs_under(const fs::path& root) {
    if (fs::is_regular_file(root)) return {root};
    std::vector<fs::path> inputs;
    if (!fs::is_directory(root)) return inputs;
    for (const auto& entry : fs::recursive_directory_iterator(root))
        if (entry.is_regular_file()) inputs.push_back(entry.path());
    std::sort(inputs.begin(), inputs.end());
    return inputs;
}

std::vector<std::uint8_t> content_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> chars{std::istreambuf_iterator<char>(file), {}};
    return {chars.begin(), chars.end()};
}

}  // namespace

int main(int argc, char** argv) {
    const std::string_view name = argc > 1 ? argv[1] : "";
    const Target* const target = std::find_if(std::begin(targets), std::end(targets),
                                              [&](const Target& candidate) { return candidate.name == name; });
    if (target == std::end(targets)) return 2;
    std::size_t count = 0;
    for (int i = 2; i < argc; ++i) {
        for (const auto& path : inputs_under(argv[i])) {
            // Named before it runs, and at once: after a crash the last line names the input.
            std::printf("%s\n", path.c_str());
            std::fflush(stdout);
            const auto content = content_of(path);
            target->run(content.data(), content.size());
            ++count;
        }
    }
    std::printf("%zu inputs replayed\n", count);
    return count == 0 ? 1 : 0;
}
