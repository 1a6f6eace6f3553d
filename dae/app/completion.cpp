// The verb `completion`: scripts for bash, zsh and fish, tables of the words that can follow a
// word, made from the options themselves.

#include <algorithm>
#include <cstdio>
#include <map>

#include "help.h"
#include "verb.h"

namespace momenta::program {
namespace {

constexpr const char* scene_endings[] = {"toml", "urdf", "xml", "mjcf", "sdf"};

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

/// Text within single quotes of a shell.
std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

std::vector<const CLI::Option*> options_of(const CLI::App& verb, bool positional) {
  std::vector<const CLI::Option*> options;
  for (const CLI::Option* o : verb.get_options())
    if (o->nonpositional() != positional) options.push_back(o);
  return options;
}

std::vector<std::string> names_of(const std::vector<const CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* o : options) names.push_back(shown_name(*o));
  return names;
}

// bash ------------------------------------------------------------------------------------------

/// Call that offers values of a type name.
std::string bash_offer(const std::string& type_name) {
  const Values values = values_of(type_name);
  switch (values.paths) {
    case Values::Paths::scenes:
      return "_momenta_files " +
             shell_quoted(joined({std::begin(scene_endings), std::end(scene_endings)}, "|"));
    case Values::Paths::files:
      return "_momenta_files '*'";
    case Values::Paths::directories:
      return "_momenta_files ''";
    case Values::Paths::none:
      break;
  }
  return (values.several ? "_momenta_list " : "_momenta_words ") +
         shell_quoted(joined(values.words, " "));
}

std::string bash_script(const CLI::App& program) {
  // Patterns "verb --option" by values.
  std::map<std::string, std::vector<std::string>> patterns;
  std::string options, positionals;
  std::vector<std::string> verbs, flags;
  for (const CLI::App* verb : verbs_of(program)) {
    verbs.push_back(verb->get_name());
    for (const CLI::Option* o : options_of(*verb, false))
      if (is_flag(*o)) {
        if (std::find(flags.begin(), flags.end(), shown_name(*o)) == flags.end())
          flags.push_back(shown_name(*o));
      } else
        patterns[bash_offer(o->get_type_name())].push_back(
            shell_quoted(verb->get_name() + " " + shown_name(*o)));
    options += "      " + verb->get_name() + ") _momenta_words " +
               shell_quoted(joined(names_of(options_of(*verb, false)), " ")) + " ;;\n";
    int place = 0;
    for (const CLI::Option* o : options_of(*verb, true))
      positionals += "      '" + verb->get_name() + " " + std::to_string(place++) + "') " +
                     bash_offer(o->get_type_name()) + " ;;\n";
  }
  std::string values;
  for (const auto& [offer, of] : patterns)
    values += "    " + joined(of, " | ") + ")\n      " + offer + " ;;\n";
  return R"(# Completes momenta in bash. Made by: momenta completion bash

_momenta_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}

# The last word of a list with commas.
_momenta_list() {
  local before=
  [[ $cur == *,* ]] && before=${cur%,*},
  mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${cur##*,}")
}

# Files with one of these endings, and folders: the way to them. '*': any file; '': folders alone.
_momenta_files() {
  local path
  compopt -o filenames 2>/dev/null
  while IFS= read -r path; do
    if [[ -d $path || $1 == '*' ]] || [[ -n $1 && $path =~ \.($1)$ ]]; then COMPREPLY+=("$path"); fi
  done < <(compgen -f -- "$cur")
}

_momenta() {
  local cur=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb= place=0 i word
  COMPREPLY=()
  # bash parts words at =: --form=momentum is three of them.
  if [[ $cur == '=' ]]; then
    cur=
  elif [[ $before == '=' ]]; then
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if [[ -z $verb ]]; then
      [[ $word == -* ]] || verb=$word
    elif [[ $word != -* && $word != '=' && ${COMP_WORDS[i - 1]} != '=' ]]; then
      # Neither an option nor what one takes.
      if [[ ${COMP_WORDS[i - 1]} != --* || ${COMP_WORDS[i - 1]} == @()" +
         joined(flags, "|") + R"() ]]; then ((++place)); fi
    fi
  done
  if [[ -z $verb ]]; then
    _momenta_words ')" +
         joined(verbs, " ") + " " + joined(names_of(options_of(program, false)), " ") + R"('
    return
  fi
  _momenta_value "$verb $before" && return
  if [[ $cur == -* ]]; then
    case $verb in
)" + options +
         R"(    esac
  else
    case "$verb $place" in
)" + positionals +
         R"(    esac
  fi
}

# Offers what an option of a verb takes; false of what takes nothing.
_momenta_value() {
  case $1 in
)" + values +
         R"(    *) return 1 ;;
  esac
  return 0
}

complete -F _momenta momenta
)";
}

// zsh -------------------------------------------------------------------------------------------

/// Text within a specification of _arguments, where : [ ] are special.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == ':' || c == '[' || c == ']' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_action(const std::string& type_name) {
  const Values values = values_of(type_name);
  switch (values.paths) {
    case Values::Paths::scenes:
      return "_files -g \"*.(" + joined({std::begin(scene_endings), std::end(scene_endings)}, "|") +
             ")\"";
    case Values::Paths::files:
      return "_files";
    case Values::Paths::directories:
      return "_files -/";
    case Values::Paths::none:
      break;
  }
  if (values.words.empty()) return " ";
  return values.several ? "_sequence -s , compadd - " + joined(values.words, " ")
                        : "(" + joined(values.words, " ") + ")";
}

std::string zsh_script(const CLI::App& program) {
  std::string verbs, cases;
  for (const CLI::App* verb : verbs_of(program)) {
    verbs +=
        "    " + shell_quoted(zsh_text(verb->get_name()) + ":" + verb->get_description()) + "\n";
    cases += "    " + verb->get_name() + ")\n      _arguments";
    for (const CLI::Option* o : verb->get_options()) {
      const std::string type_name = o->get_type_name();
      std::string spec;
      if (!o->nonpositional())
        spec = std::string(o->get_required() ? ":" : "::") + zsh_text(shown_name(*o)) + ":" +
               zsh_action(type_name);
      else
        spec = shown_name(*o) + (is_flag(*o) ? "" : "=") + "[" + zsh_text(shown_text(*o)) + "]" +
               (is_flag(*o) ? "" : ":" + zsh_text(type_name) + ":" + zsh_action(type_name));
      cases += " \\\n        " + shell_quoted(spec);
    }
    cases += " ;;\n";
  }
  return R"(#compdef momenta
# Completes momenta in zsh. Made by: momenta completion zsh

_momenta() {
  local context state state_descr line
  local -A opt_args
  local -a verbs=(
)" + verbs +
         R"(  )
  _arguments -C '(- *)--help[help]' '(- *)--version[version]' '1:verb:->verb' '*::argument:->argument' && return
  if [[ $state == verb ]]; then
    _describe -t verbs verb verbs
    return
  fi
  case $words[1] in
)" + cases +
         R"(  esac
}

_momenta "$@"
)";
}

// fish ------------------------------------------------------------------------------------------

std::string fish_values(const std::string& type_name) {
  const Values values = values_of(type_name);
  switch (values.paths) {
    case Values::Paths::scenes:
      return " -x -a " + shell_quoted(
                             "(__fish_complete_path (commandline -ct) | string match -r "
                             "'.*(?:/|\\.(?:" +
                             joined({std::begin(scene_endings), std::end(scene_endings)}, "|") +
                             "))(?:\\t.*)?$')");
    case Values::Paths::files:
      return " -r -F";
    case Values::Paths::directories:
      return " -x -a '(__fish_complete_directories)'";
    case Values::Paths::none:
      break;
  }
  if (values.words.empty()) return " -x";
  if (values.several)
    return " -x -a " + shell_quoted("(__fish_append , " + joined(values.words, " ") + ")");
  return " -x -a " + shell_quoted(joined(values.words, " "));
}

std::string fish_script(const CLI::App& program) {
  std::string out =
      "# Completes momenta in fish. Made by: momenta completion fish\n\ncomplete -c momenta -f\n";
  for (const CLI::Option* o : options_of(program, false))
    out += "complete -c momenta -n __fish_use_subcommand -l " + shown_name(*o).substr(2) + " -d " +
           shell_quoted(o->get_description()) + "\n";
  for (const CLI::App* verb : verbs_of(program)) {
    out += "complete -c momenta -n __fish_use_subcommand -a " + verb->get_name() + " -d " +
           shell_quoted(verb->get_description()) + "\n";
    for (const CLI::Option* o : verb->get_options()) {
      const std::string when =
          "complete -c momenta -n '__fish_seen_subcommand_from " + verb->get_name() + "'";
      if (!o->nonpositional())
        out += when + fish_values(o->get_type_name()) + "\n";
      else
        out += when + " -l " + shown_name(*o).substr(2) +
               (is_flag(*o) ? "" : fish_values(o->get_type_name())) + " -d " +
               shell_quoted(shown_text(*o)) + "\n";
    }
  }
  return out;
}

}  // namespace

Verb declare_completion(CLI::App& app, Options&) {
  const auto own = std::make_shared<std::string>();
  CLI::App& verb = add_verb(app, "completion", "Prints a script that completes this command line",
                            "momenta completion bash > momenta");
  one_of(verb.add_option("shell", *own, "For which shell")->required(), {"bash", "zsh", "fish"});
  return {&verb, [own, &app] {
            const std::string script = *own == "bash"  ? bash_script(app)
                                       : *own == "zsh" ? zsh_script(app)
                                                       : fish_script(app);
            return std::fputs(script.c_str(), stdout), done;
          }};
}

}  // namespace momenta::program
