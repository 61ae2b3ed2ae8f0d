// sinew completion SHELL: the scripts of completions/, embedded at build time.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "commands.h"
#include "completions.h"

void add_completion(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("completion", "Print the completion script of a shell");
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer(R"(
Examples:
  sinew completion bash > ~/.local/share/bash-completion/completions/sinew
  sinew completion zsh > ~/.zfunc/_sinew
  sinew completion fish > ~/.config/fish/completions/sinew.fish)");
  command->callback([shell] {
    fmt::print("{}", *shell == "bash"  ? bash_completion
                     : *shell == "zsh" ? zsh_completion
                                       : fish_completion);
  });
}
