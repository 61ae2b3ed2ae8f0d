"""The shell completions have every command and option of the binary, and are printed unchanged."""

import re
import subprocess
import unittest

from cli_support import ROOT, CliTest

SHELLS = ("bash", "zsh", "fish")


def text(shell):
    return (ROOT / "completions" / f"sinew.{shell}").read_text(encoding="utf-8")


class CompletionTest(CliTest):
    def help_of(self, *words):
        return self.run_sinew(*words, "--help").stdout

    def commands(self):
        listed = self.help_of().partition("Subcommands:")[2].partition("\n\n")[0]
        found = re.findall(r"^  (\w+) ", listed, re.MULTILINE)
        self.assertIn("run", found)
        return found

    def test_every_command_and_option_is_known(self):
        for command in self.commands():
            options = set(re.findall(r"^  (?:-\w,)?--([\w-]+)", self.help_of(command), re.MULTILINE))
            self.assertIn("help", options)
            for shell in SHELLS:
                words = [rf"\b{command}\b"]
                words += [(r"-l " if shell == "fish" else "--") + rf"{o}\b" for o in options]
                for word in words:
                    known = re.search(word, text(shell)) is not None
                    self.assertTrue(known, f"completions/sinew.{shell}, {command}: no {word}")

    def test_printed_as_they_stand(self):
        for shell in SHELLS:
            self.assertEqual(self.run_sinew("completion", shell).stdout, text(shell))

    def complete(self, *words):
        """What bash offers for the last of these words."""
        script = """source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
            _sinew; printf '%s\\n' "${COMPREPLY[@]}" """
        command = ["bash", "-c", script, "bash", ROOT / "completions/sinew.bash", "sinew", *words]
        run = subprocess.run(command, cwd=self.dir, text=True, capture_output=True, check=True)
        return run.stdout.split()

    def test_bash_offers_commands_files_and_options(self):
        self.write("scenes/liver.toml", "")
        self.write("scenes/notes.txt", "")
        self.write("liver.mesh", "")
        self.assertEqual(self.complete("res"), ["resume"])
        self.assertEqual(self.complete("run", "scenes/"), ["scenes/liver.toml"])
        self.write("framework/chain-scene.txt", "")
        self.assertEqual(self.complete("run", "framework/"), ["framework/chain-scene.txt"])
        self.assertEqual(self.complete("run", "--o"), ["--out"])
        self.assertEqual(self.complete("info", "l"), ["liver.mesh"])


if __name__ == "__main__":
    unittest.main()
