// SPDX-License-Identifier: MIT
// The main of a fuzz target in builds without a fuzzing engine: runs every file of the folders (or files) given as
// arguments, so that each input that once broke something is tried in every test run. Fails when there is no input at
// all: an empty corpus proves nothing.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

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
    std::size_t count = 0;
    for (int i = 1; i < argc; ++i) {
        for (const auto& path : inputs_under(argv[i])) {
            // Named before it runs, and at once: after a crash the last line names the input.
            std::printf("%s\n", path.c_str());
            std::fflush(stdout);
            const auto content = content_of(path);
            LLVMFuzzerTestOneInput(content.data(), content.size());
            ++count;
        }
    }
    std::printf("%zu inputs replayed\n", count);
    return count == 0 ? 1 : 0;
}
