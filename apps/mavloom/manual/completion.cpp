// SPDX-License-Identifier: MIT
// `mavloom completion SHELL` prints a script that asks `mavloom completion words -- WORD...` at each key. So the shells
// know no option by themselves.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "command.hpp"
#include "ctl/actions.hpp"
#include "manual/candidates.hpp"
#include "mavloom/control/control.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/shm/counter_page.hpp"
#include "mavloom/shm/ring_info.hpp"
#include "output.hpp"

namespace mavloom::app {

namespace {

// bash splits words at ":" and "=". bash-completion's functions join them again; without them, bash completes up to the
// first of these.
constexpr std::string_view bash =
    R"sh(# eval "$(mavloom completion bash)", or as a file in /usr/share/bash-completion/completions/mavloom
_mavloom() {
  local cur words cword line
  COMPREPLY=()
  if declare -F _get_comp_words_by_ref >/dev/null; then
    _get_comp_words_by_ref -n ':=' cur words cword
  else
    cur=${COMP_WORDS[COMP_CWORD]} words=("${COMP_WORDS[@]}") cword=$COMP_CWORD
  fi
  while IFS= read -r line; do
    if [[ $line == :files ]]; then
      [[ ${#COMPREPLY[@]} == 0 ]] && compopt -o filenames
      while IFS= read -r line; do COMPREPLY+=("$line"); done < <(compgen -f -- "$cur")
    else
      COMPREPLY+=("${line%%$'\t'*}")
    fi
  done < <(mavloom completion words -- "${words[@]:1:cword}" 2>/dev/null)
  [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *[:/=.,] ]] && compopt -o nospace
  if [[ $cur == *=* && $COMP_WORDBREAKS == *=* ]]; then COMPREPLY=("${COMPREPLY[@]#"${cur%"${cur##*=}"}"}"); fi
  if declare -F __ltrim_colon_completions >/dev/null; then __ltrim_colon_completions "$cur"; fi
}
complete -F _mavloom mavloom
)sh";

constexpr std::string_view zsh = R"sh(#compdef mavloom
# As the file _mavloom in a folder of $fpath, or: source <(mavloom completion zsh)
_mavloom() {
  local line files=
  local -a found described
  for line in "${(@f)$(mavloom completion words -- "${(@)words[2,CURRENT]}" 2>/dev/null)}"; do
    [[ -z $line ]] && continue
    if [[ $line == :files ]]; then files=yes; continue; fi
    found+=("${line%%$'\t'*}")
    described+=("${line/$'\t'/  -- }")
  done
  (( $#found )) && compadd -S '' -l -d described -a found
  [[ -n $files ]] && _files
}
if [[ $funcstack[1] == _mavloom ]]; then _mavloom "$@"; else compdef _mavloom mavloom; fi
)sh";

constexpr std::string_view fish = R"sh(# mavloom completion fish | source, or as the file mavloom.fish in a folder of completions
function __mavloom_complete
    set -l typed (commandline -ct)
    for line in (mavloom completion words -- (commandline -opc)[2..-1] "$typed" 2>/dev/null)
        if test "$line" = :files
            __fish_complete_path "$typed"
        else
            echo $line
        end
    end
end
complete -c mavloom -f -a '(__mavloom_complete)'
)sh";

struct CompletionOptions {
    std::string shell;
    std::vector<std::string> words;
};

std::vector<std::string> message_names() {
    std::vector<std::string> names;
    for (const auto& message : dialect::default_dialect().messages()) names.emplace_back(message.name);
    return names;
}

std::vector<std::string> field_names(const std::string& message) {
    std::vector<std::string> names;
    if (const auto* const found = dialect::default_dialect().find(message))
        for (const auto& field : found->fields) names.emplace_back(field.name);
    return names;
}

// A killed program leaves its counter page behind.
std::vector<std::string> running_names() {
    auto names = shm::counter_page_names();
    std::erase_if(names, [](const std::string& name) {
        const auto page = shm::read_counters(name, {.user = link::Links::owner_of_inlets()});
        return !page || !page->owner_alive;
    });
    return names;
}

// Of the endpoints, too, which `ctl NAME remove` takes.
std::vector<std::string> link_names(const std::string& program) {
    constexpr std::chrono::milliseconds patience{300};
    const auto lines = control::send_request(program, R"({"cmd":"links"})", patience);
    std::set<std::string> names;
    for (const auto& line : lines.value_or(std::vector<std::string>())) {
        const auto object = nlohmann::json::parse(line, nullptr, false);
        if (!object.is_object()) continue;
        for (const auto* const key : {"link", "endpoint"}) names.insert(object.value(key, ""));
    }
    names.erase("");
    return {names.begin(), names.end()};
}

Exit print_words(const Arguments& self, const std::vector<std::string>& words) {
    const auto found = candidates(
        self.program(), words, {message_names, shm::ring_names, running_names, ctl_actions, field_names, link_names});
    std::string text;
    for (const auto& candidate : found.all)
        text += candidate.word + (candidate.description.empty() ? "" : "\t" + candidate.description) + "\n";
    if (found.and_files) text += ":files\n";
    return print_at_end(text, Exit::done);
}

}  // namespace

Run declare_completion(Arguments command, const Common& /*common*/) {
    auto options = std::make_shared<CompletionOptions>();
    command.add_option("shell", "SHELL", options->shell, "the shell; words: what may follow the words after --")
        .required()
        .members({"bash", "zsh", "fish", "words"});
    command.add_option("words", "WORD", options->words,
                       "the words of a command line without mavloom, the last unfinished");
    command.footer(
        "bash: eval \"$(mavloom completion bash)\"\n"
        "zsh:  source <(mavloom completion zsh)\n"
        "fish: mavloom completion fish | source");
    return [options, command] {
        if (options->shell == "words") return print_words(command, options->words);
        return print_at_end(options->shell == "bash" ? bash : options->shell == "zsh" ? zsh : fish, Exit::done);
    };
}

}  // namespace mavloom::app
