// Help, manual and completions: of every verb there is, and of nothing the program does not take.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "dae/app/program.h"

namespace momenta::golden::dae_help {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Letters, without the marks U+0300 to U+036F above them.
int letters(const std::string& line) {
  int count = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const auto at = [&](std::size_t k) { return static_cast<unsigned char>(line[k]); };
    if (at(i) >= 0x80 && at(i) < 0xc0) continue;
    const int two = i + 1 < line.size() ? (at(i) & 0x1f) << 6 | (at(i + 1) & 0x3f) : 0;
    count += at(i) < 0xc0 || at(i) >= 0xe0 || two < 0x300 || two > 0x36f;
  }
  return count;
}

class Help : public Program {
 protected:
  Help() {
    fs::create_directory_symlink(std::string(MOMENTA_SOURCE_DIR) + "/examples",
                                 folder_ / "examples");
    fs::create_directory(folder_ / "bin");
    fs::create_symlink(MOMENTA_BINARY_DIR "/dae/momenta", folder_ / "bin" / "momenta");
  }
  /// As typed in a shell, beside examples/ and with momenta on the path.
  Outcome typed(const std::string& command) const {
    const fs::path out = folder_ / "stdout", err = folder_ / "stderr";
    const std::string all = "cd '" + folder_.string() + "' && PATH=\"$PWD/bin:$PATH\" && { " +
                            command + "\n} >'" + out.string() + "' 2>'" + err.string() +
                            "' </dev/null";
    const int raw = std::system(all.c_str());  // NOLINT: the command is this test's own
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -WTERMSIG(raw), text_of(out), text_of(err)};
  }
  /// First words of rows and further options beside them: verbs of the program's help, options of a
  /// verb's.
  std::vector<std::string> rows_of(const std::string& help) const {
    std::vector<std::string> names;
    for (const std::string& line : lines_of(help))
      if (line.size() > 2 && line.starts_with("  ") && line[2] != ' ') {
        std::istringstream words(line.substr(0, line.find("  ", 2)));
        bool first = true;
        for (std::string word; words >> word; first = false) {
          if (word.back() == ',') word.pop_back();
          if (first || word.starts_with("--")) names.push_back(word);
        }
      }
    return names;
  }
  std::vector<std::string> verbs() const {
    std::vector<std::string> names;
    for (const std::string& name : rows_of(call("--help").out))
      if (!name.starts_with("--")) names.push_back(name);
    return names;
  }
  std::vector<std::string> options_of(const std::string& verb) const {
    std::vector<std::string> names;
    for (const std::string& name : rows_of(call(verb + " --help").out))
      if (name.starts_with("--")) names.push_back(name);
    return names;
  }
  /// What bash offers for the last of these words.
  std::set<std::string> offered(const std::string& words) const {
    const Outcome o = typed(
        "momenta completion bash >momenta.bash && bash -c '. ./momenta.bash; COMP_WORDS=(" + words +
        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _momenta; printf "
        "\"%s\\n\" \"${COMPREPLY[@]}\"'");
    EXPECT_EQ(o.status, 0) << o.err;
    EXPECT_EQ(o.err, "") << words;
    std::set<std::string> all;
    for (const std::string& line : lines_of(o.out))
      if (!line.empty()) all.insert(line);
    return all;
  }
  static bool installed(const std::string& name) {
    return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;  // NOLINT
  }
};

using Names = std::set<std::string>;

TEST_F(Help, FitsAScreenAndHoldsAnExample) {
  const auto all = verbs();
  EXPECT_GE(all.size(), 13u);
  for (std::string verb : all) {
    const Outcome o = call(verb + " --help");
    EXPECT_EQ(o.status, 0);
    EXPECT_NE(o.out.find("Usage: momenta " + verb), std::string::npos) << o.out;
    EXPECT_NE(o.out.find("\nExample: momenta " + verb + " "), std::string::npos)
        << verb << " has no footer(\"Example: momenta " << verb << " …\")";
    EXPECT_LE(lines_of(o.out).size(), 43u) << verb;
    for (const std::string& line : lines_of(o.out)) EXPECT_LE(letters(line), 80) << line;
  }
  const std::string own = call("--help").out;
  EXPECT_LE(lines_of(own).size(), 40u);
  for (const std::string& line : lines_of(own)) EXPECT_LE(letters(line), 80) << line;
}

TEST_F(Help, ExamplesRun) {
  std::vector<std::string> helps{call("--help").out};
  for (const std::string& verb : verbs()) helps.push_back(call(verb + " --help").out);
  for (const std::string& help : helps) {
    const auto from = help.find("Example: ");
    ASSERT_NE(from, std::string::npos) << help;
    std::string example = help.substr(from + 9, help.find('\n', from) - from - 9);
    // The program's own example is a study of a minute: a second of it does.
    if (&help == &helps.front()) example += " --end 1";
    const Outcome o = typed(example);
    EXPECT_EQ(o.status, 0) << example << "\n" << o.err;
    const bool written = fs::exists(folder_ / "results") || fs::exists(folder_ / "ur5.toml") ||
                         fs::exists(folder_ / "stewart.toml") || fs::exists(folder_ / "momenta");
    EXPECT_TRUE(written || !o.out.empty()) << example;
    for (const char* made : {"ur5.toml", "stewart.toml", "momenta"}) fs::remove(folder_ / made);
    fs::remove_all(folder_ / "results");
  }
}

TEST_F(Help, NamesWhatTheProgramTakes) {
  const std::string scene = " '" + example("four_bar") + "' --quiet --end 0.01 ";
  const Names forms = offered("momenta run --form \"\"");
  EXPECT_GE(forms.size(), 16u);
  for (const std::string& form : forms) {
    EXPECT_EQ(call("run" + scene + "--form " + form).status, 0) << form;
    EXPECT_NE(call("run --help").out.find(form), std::string::npos) << form;
  }
  for (const std::string& gauge : offered("momenta run --gauge \"\""))
    EXPECT_EQ(call("run" + scene + "--integrator rk4 --gauge " + gauge).status, 0) << gauge;
  for (const std::string& name : offered("momenta run --integrator \"\"")) {
    const Outcome o = call("run" + scene + "--integrator " + name);
    EXPECT_EQ(o.err.find("not in"), std::string::npos) << o.err;
  }
  for (const std::string& family : offered("momenta make \"\""))
    EXPECT_EQ(call("make " + family).status, 0) << family;
}

TEST_F(Help, ManualHoldsEveryVerbAndOptionAndRendersWithoutWarning) {
  const Outcome roff = call("manual");
  ASSERT_EQ(roff.status, 0);
  std::string page = roff.out;
  for (std::size_t at = 0; (at = page.find("\\-", at)) != std::string::npos;) page.erase(at, 1);
  for (const std::string& verb : verbs()) {
    EXPECT_NE(page.find("\n\\fB" + verb + "\\fR"), std::string::npos) << verb;
    EXPECT_NE(page.find("\nmomenta " + verb + " "), std::string::npos) << verb;
    for (const std::string& option : options_of(verb))
      EXPECT_NE(page.find("\\fB" + option + "\\fR"), std::string::npos) << verb << " " << option;
  }
  if (!installed("man")) GTEST_SKIP() << "man is not installed";
  const fs::path file = write("momenta.1", roff.out);
  const Outcome man =
      typed("LC_ALL=C.UTF-8 MANWIDTH=80 MANROFFSEQ= man --warnings -E UTF-8 -l -Tutf8 '" +
            file.string() + "'");
  EXPECT_EQ(man.status, 0);
  EXPECT_EQ(man.err, "");
  EXPECT_GT(man.out.size(), 2 * roff.out.size() / 3);
}

TEST_F(Help, BashCompletesVerbsOptionsAndWhatTheyTake) {
  const auto all = verbs();
  Names expected(all.begin(), all.end());
  expected.insert({"--help", "--version"});
  EXPECT_EQ(offered("momenta \"\""), expected);
  EXPECT_EQ(offered("momenta dr"), Names{"drift"});
  for (const std::string& verb : all) {
    const auto options = options_of(verb);
    expected = Names(options.begin(), options.end());
    expected.insert("--help");
    EXPECT_EQ(offered("momenta " + verb + " -"), expected) << verb;
  }
  EXPECT_EQ(offered("momenta run --kkt s"), (Names{"sparse", "sweeps"}));
  EXPECT_EQ(offered("momenta run --kkt = s"), (Names{"sparse", "sweeps"}));
  EXPECT_EQ(offered("momenta run scene.toml --gauge r"), Names{"reset"});
  EXPECT_EQ(offered("momenta drift --forms momentum,acceleration-index1,stab"),
            Names{"momentum,acceleration-index1,stabilised-index2"});
  EXPECT_EQ(offered("momenta work --integrators dop853,ver"), Names{"dop853,vern9"});
  EXPECT_EQ(offered("momenta completion \"\""), (Names{"bash", "fish", "zsh"}));
  EXPECT_EQ(offered("momenta run --rtol \"\""), Names{});
}

TEST_F(Help, BashCompletesScenesAndFolders) {
  for (const char* name : {"arm.toml", "arm.urdf", "arm.xml", "arm.mjcf", "arm.txt", "arm.tomlx"})
    write(name, "");
  fs::create_directory(folder_ / "armoury");
  const Names scenes{"arm.toml", "arm.urdf", "arm.xml", "arm.mjcf", "armoury"};
  EXPECT_EQ(offered("momenta run ar"), scenes);
  EXPECT_EQ(offered("momenta run --json --end 3 ar"), scenes);
  EXPECT_EQ(offered("momenta run --form=momentum ar"), scenes);
  EXPECT_EQ(offered("momenta run --form = momentum ar"), scenes);
  EXPECT_EQ(offered("momenta run arm.toml ar"), Names{});
  EXPECT_EQ(offered("momenta run --out ar"), Names{"armoury"});
  EXPECT_EQ(offered("momenta run --reference arm.t"), (Names{"arm.toml", "arm.tomlx", "arm.txt"}));
  EXPECT_EQ(offered("momenta convert arm.xml arm.t"), (Names{"arm.toml", "arm.tomlx", "arm.txt"}));
}

TEST_F(Help, FishCompletes) {
  if (!installed("fish")) GTEST_SKIP() << "fish is not installed";
  const auto fish = [&](const std::string& line) {
    const Outcome o = typed(
        "momenta completion fish >momenta.fish && HOME=\"$PWD\" fish --no-config -c 'source "
        "momenta.fish; "
        "complete -C \"" +
        line + "\"'");
    EXPECT_EQ(o.err, "");
    Names first;
    for (const std::string& l : lines_of(o.out)) first.insert(l.substr(0, l.find('\t')));
    return first;
  };
  write("arm.toml", "");
  write("arm.txt", "");
  EXPECT_EQ(fish("momenta dri"), Names{"drift"});
  EXPECT_EQ(fish("momenta run --kkt s"), (Names{"sparse", "sweeps"}));
  EXPECT_EQ(fish("momenta drift --forms momentum,stab"), Names{"momentum,stabilised-index2"});
  EXPECT_EQ(fish("momenta view --integ"), Names{});
  EXPECT_EQ(fish("momenta run --integ"), Names{"--integrator"});
  EXPECT_EQ(fish("momenta run arm.t"), Names{"arm.toml"});
}

TEST_F(Help, ZshCompletes) {
  if (!installed("zsh")) GTEST_SKIP() << "zsh is not installed";
  // A shell of its own behind a pseudo terminal, in which keys are typed; momenta says what it got.
  const auto zsh = [&](const std::string& keys) {
    write("type.zsh",
          "zmodload zsh/zpty\nzpty -b z zsh -f -i\n"
          "zpty -w z 'PS1=; cd " +
              folder_.string() +
              "; fpath=($PWD $fpath); autoload -Uz compinit; compinit -u -D; "
              "momenta() { print -r -- \"<$*>\" }'\n"
              "zpty -w z $'" +
              keys +
              "'\nzpty -w z $'\\nprint -r -- \"<end>\"'\n"
              "text=; for i in {1..300}; do if zpty -r -t z more; then text+=$more; else sleep "
              "0.05; fi; "
              "[[ $text == *$'\\n<end>'* ]] && break; done\nprint -r -- $text\nzpty -d z\n");
    const Outcome o =
        typed("momenta completion zsh >_momenta && HOME=\"$PWD\" TERM=dumb zsh -f type.zsh");
    EXPECT_EQ(o.err, "");
    std::string got = "nothing in: " + o.out;
    for (const std::string& line : lines_of(o.out))
      if (line.starts_with("<") && !line.starts_with("<end>"))
        got = line.substr(1, line.find('>') - 1);
    return got;
  };
  write("arm.toml", "");
  write("arm.txt", "");
  EXPECT_EQ(zsh("momenta dri\\t"), "drift");
  EXPECT_EQ(zsh("momenta run --kkt sw\\t"), "run --kkt sweeps");
  EXPECT_EQ(zsh("momenta run arm\\t"), "run arm.toml");
  EXPECT_EQ(zsh("momenta drift --forms momentum,stab\\t"),
            "drift --forms momentum,stabilised-index2");
}

}  // namespace

}  // namespace momenta::golden::dae_help
