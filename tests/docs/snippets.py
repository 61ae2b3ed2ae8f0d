"""The documentation's own commands, scenes, code and links are tests.

    snippets.py run      runs the fenced blocks of README.md, CONTRIBUTING.md and docs/**/*.md
    snippets.py links    checks that relative links and their anchors lead somewhere

What happens to a block follows from its first line:

    ```sh, ```bash       every line is run by bash, and every command has to succeed
    ```console           the lines that start with "$ " are run; the rest shows output
    ```toml              a scene that has to run, when the first line is a comment "# scene ..."
    ```cpp test          has to compile against the library
    anything else        is left alone

An HTML comment `<!-- test: skip (why) -->` on the line above a block leaves it alone too. A block
below `<!-- from: FILE -->` has to be the text of that file of the repository.
The blocks of one page run in order in one scratch copy of the repository, so that a later one can
use what an earlier one made. `sinew` is on PATH there; `./dev run ...` and `./dev build` use the
binary under test, and no other command of ./dev is run from a page. Environment: SINEW_BIN.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BLOCK_SECONDS = 300
SCENE_SECONDS = 0.005  # how long a scene of a page is simulated

FENCE = re.compile(r"^(?P<indent> *)(?P<ticks>```+)(?P<tag>[^`]*)$")
FROM = re.compile(r"<!--\s*from:\s*(\S+)\s*-->")
SKIP = re.compile(r"<!--\s*test:\s*skip\s*\([^)]+\)\s*-->")
LINK = re.compile(r"""\]\(\s*<?([^)\s>]+)>?[^)]*\)|(?:src|href)="([^"]+)\"""")

DEV_SHIM = """#!/usr/bin/env bash
set -e
case $1 in
  build) ;;
  run) shift && exec sinew run "$@" ;;
  *) echo "./dev $1 is not run from a page: put <!-- test: skip (why) --> above the block" >&2
     exit 1 ;;
esac
"""


class Block:
    def __init__(self, line, tag, text, skipped, source):
        self.line = line  # of the opening fence, from 1
        self.tag = tag.strip()
        self.text = text
        self.skipped = skipped
        self.source = source  # the file whose text it shows, or None

    def script(self):
        """The shell script in this block; None when it is none."""
        if self.tag in ("sh", "bash"):
            return self.text
        if self.tag != "console":
            return None
        commands, continued = [], False
        for line in self.text.splitlines():
            if continued or line.startswith("$ "):
                commands.append(line if continued else line[2:])
                continued = line.endswith("\\")
        return "\n".join(commands)


def pages():
    top = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
    found = [page for page in top if page.exists()]
    for folder in ("docs", "scenes", "validation"):
        found += sorted((ROOT / folder).rglob("*.md"))
    return found


def blocks_of(page):
    """The fenced blocks of a page. Raises ValueError on one that is not closed."""
    found, fence, body, previous = [], None, [], ""
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        match = FENCE.match(line)
        if fence is None and match:
            fence, start, skipped, body = match, number, bool(SKIP.search(previous)), []
            source = FROM.search(previous)
        elif fence and line.strip() == fence["ticks"]:
            found.append(Block(start, fence["tag"], "\n".join(body) + "\n", skipped,
                               source and source[1]))
            fence = None
        elif fence:
            body.append(line.removeprefix(fence["indent"]))
        elif line.strip():
            previous = line
    if fence:
        raise ValueError(f"{page}:{start}: this block is never closed")
    return found


def prose_of(page):
    """(line number, text) outside of fenced blocks and inline code."""
    ticks = None
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        match = FENCE.match(line)
        if ticks is None and match:
            ticks = match["ticks"]
        elif ticks is not None:
            ticks = None if line.strip() == ticks else ticks
        else:
            yield number, re.sub(r"`[^`]*`", "", line)


def anchors_of(page):
    """The anchors that a page's headings get when it is shown on a forge."""
    seen = {}
    ticks = None
    for line in page.read_text(encoding="utf-8").splitlines():
        match = FENCE.match(line)
        if match and ticks is None:
            ticks = match["ticks"]
        elif ticks is not None and line.strip() == ticks:
            ticks = None
        elif ticks is None and re.match(r"#{1,6} ", line):
            text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", line.lstrip("#").strip()).lower()
            slug = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
            count = seen.get(slug, 0)
            seen[slug] = count + 1
            yield f"{slug}-{count}" if count else slug


def check_links():
    faults = 0
    for page in pages():
        for number, line in prose_of(page):
            for match in LINK.finditer(line):
                target = urllib.parse.unquote(match[1] or match[2])
                if re.match(r"[a-z]+:", target):
                    continue
                name, _, anchor = target.partition("#")
                path = (page.parent / name).resolve() if name else page
                reason = None
                if not path.exists():
                    reason = "no such file"
                elif anchor and path.suffix == ".md" and anchor not in set(anchors_of(path)):
                    reason = f"no heading #{anchor} there"
                if reason:
                    print(f"{page.relative_to(ROOT)}:{number}: {target}: {reason}")
                    faults += 1
    return faults


class Scratch:
    """A copy of the repository's files, with `sinew` on PATH and a ./dev that does not build."""

    def __init__(self, folder):
        self.root = pathlib.Path(folder) / "sinew"
        skip = shutil.ignore_patterns(".git", "build", "out", "node_modules", "__pycache__", "*.tmp")
        shutil.copytree(ROOT, self.root, ignore=skip)
        dev = self.root / "dev"
        dev.write_text(DEV_SHIM)
        dev.chmod(0o755)
        bin_folder = pathlib.Path(folder) / "bin"
        bin_folder.mkdir()
        (bin_folder / "sinew").symlink_to(pathlib.Path(os.environ["SINEW_BIN"]).resolve())
        self.env = dict(os.environ, PATH=f"{bin_folder}:/usr/bin:{os.environ['PATH']}")

    def run(self, *command):
        """None when the command succeeds, else what it printed."""
        try:
            done = subprocess.run(command, cwd=self.root, env=self.env, text=True,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, timeout=BLOCK_SECONDS)
        except subprocess.TimeoutExpired:
            return f"not done after {BLOCK_SECONDS} s"
        return None if done.returncode == 0 else f"{done.stdout}exit code {done.returncode}"

    def run_block(self, block):
        """(whether the block was tested, None or what went wrong)"""
        script = block.script()
        if script is not None:
            return True, self.run("bash", "-euo", "pipefail", "-c", script)
        if block.tag == "toml" and block.text.startswith("# scene"):
            scene = self.root / "scenes" / "snippet.toml"
            scene.write_text(block.text)
            return True, self.run("sinew", "run", str(scene), "--quiet", "--no-output",
                                  "--set", f"duration={SCENE_SECONDS}")
        if block.source:
            there = self.root / block.source
            same = there.is_file() and there.read_text(encoding="utf-8") == block.text
            return True, None if same else f"it is not the text of {block.source}"
        if block.tag == "cpp test":
            source = self.root / "snippet.cpp"
            source.write_text(block.text)
            return True, self.run(os.environ.get("CXX", "g++"), "-std=c++20", "-fsyntax-only",
                                  "-Wall", "-Wextra", "-Iinclude", "-Isrc",
                                  "-I/usr/include/eigen3", str(source))
        return False, None


def run_blocks():
    faults, tested = 0, 0
    for page in pages():
        blocks = [b for b in blocks_of(page) if not b.skipped]
        with tempfile.TemporaryDirectory(prefix="sinew-docs-") as folder:
            scratch = Scratch(folder)
            for block in blocks:
                ran, trouble = scratch.run_block(block)
                tested += ran
                if trouble is not None:
                    faults += 1
                    print(f"{page.relative_to(ROOT)}:{block.line}: this block fails:\n"
                          f"{block.text}---\n{trouble}\n")
    print(f"{tested} blocks tested, {faults} failed")
    return faults


def main(argv):
    actions = {"run": run_blocks, "links": check_links}
    if len(argv) != 2 or argv[1] not in actions:
        print(__doc__, file=sys.stderr)
        return 2
    return 1 if actions[argv[1]]() else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
