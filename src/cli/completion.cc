// What bash completes, from the same tables as --help.
#include "base/text.h"
#include "help.h"

namespace pbnbrdf::cli {
namespace {

// Bash breaks words at '=': the flag that a value belongs to is one or two words before it.
constexpr char kBegin[] = R"(# bash completion of pbnbrdf
_pbnbrdf() {
  local current=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} flag= flags= choices=
  if [[ $current == = ]]; then
    flag=${COMP_WORDS[COMP_CWORD - 1]} current=
  elif [[ ${COMP_WORDS[COMP_CWORD - 1]} == = ]]; then
    flag=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  if [[ $COMP_CWORD == 1 ]]; then
    COMPREPLY=($(compgen -W "@commands@ --help --version" -- "$current"))
    return
  fi
  case $command in
)";

constexpr char kEnd[] = R"(  esac
  if [[ -n $choices ]]; then
    COMPREPLY=($(compgen -W "$choices" -- "$current"))
  elif [[ -z $flag && $current == -* ]]; then
    COMPREPLY=($(compgen -W "$flags" -- "$current"))
    [[ ${COMPREPLY[0]} == *= ]] && compopt -o nospace
  else
    compopt -o default
  fi
}
complete -F _pbnbrdf pbnbrdf
)";

std::string CaseOf(const Command& command) {
  std::vector<std::string> flags = {"--help", "--flagfile="};
  std::string choices;
  for (const Field& flag : command.flags.all()) {
    flags.push_back(StrCat("--", flag.name, flag.is_switch ? "" : "="));
    if (flag.choices.empty()) continue;
    choices += StrCat("        --", flag.name, ") choices=\"", Join(flag.choices, " "), "\" ;;\n");
  }
  return StrCat("    ", command.name, ")\n      flags=\"", Join(flags, " "),
                "\"\n      case $flag in\n", choices, "        *) ;;\n      esac\n      ;;\n");
}

}  // namespace

std::string BashCompletion(std::span<const Command> commands) {
  std::vector<std::string> names;
  std::string cases;
  for (const Command& command : commands) {
    names.push_back(command.name);
    cases += CaseOf(command);
  }
  std::string begin = kBegin;
  constexpr std::string_view kPlace = "@commands@";
  begin.replace(begin.find(kPlace), kPlace.size(), Join(names, " "));
  return begin + cases + kEnd;
}

}  // namespace pbnbrdf::cli
