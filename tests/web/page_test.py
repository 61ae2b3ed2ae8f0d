"""Tests of the page of the live view, which node runs.

    page_test.py unit      its parts, in node alone
    page_test.py built     web/dist/index.html matches web/src
    page_test.py view      the page in headless Chromium with `sinew view` behind it
    page_test.py tools     ball, obstacles, contacts, springs, cut, comparison of laws
    page_test.py data      plots, downloads, gallery and dropped files
    page_test.py states    what the documentation shows, with pictures in build/.../web
    page_test.py soak      twenty seconds of random use
    page_test.py server    losing and finding the server again, tokens, frames a second and latency

Without node 18 or what `./dev web` fetches, and for the last five without Chromium, a test is
skipped (exit code 77) and says what is missing; with SINEW_WEB=required it fails.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

WEB = pathlib.Path(__file__).resolve().parent.parent.parent / "web"
CHROMIUMS = ("chromium", "chromium-browser", "google-chrome")
SKIPPED = 77


def missing(name):
    """What the test needs and is not here; None when all is."""
    node = shutil.which("node")
    if not node:
        return "node 18 or newer: ./dev setup web"
    version = subprocess.run([node, "--version"], capture_output=True, text=True).stdout.strip()
    if int(version.lstrip("v").split(".")[0]) < 18:
        return f"node 18 or newer; this is {version}"
    if not (WEB / "node_modules" / ".installed").exists():
        return "what the page is built from: ./dev web"
    has_browser = os.environ.get("SINEW_CHROMIUM") or any(map(shutil.which, CHROMIUMS))
    if name not in ("unit", "built") and not has_browser:
        return "Chromium: ./dev setup browser, or name one by SINEW_CHROMIUM"
    return None


def node(*arguments):
    return subprocess.run(["node", *map(str, arguments)], cwd=WEB).returncode


def is_built():
    with tempfile.TemporaryDirectory(prefix="sinew-page-") as folder:
        code = node("node_modules/vite/bin/vite.js", "build", "--logLevel", "warn",
                    "--outDir", folder, "--emptyOutDir")
        if code != 0:
            return code
        if (pathlib.Path(folder) / "index.html").read_bytes() == (WEB / "dist/index.html").read_bytes():
            return 0
    print("web/dist/index.html is not what web/src gives: ./dev web, and commit it")
    return 1


def main(argv):
    name = argv[1]
    lacks = missing(name)
    if lacks:
        print(f"skipped, for want of {lacks}")
        return 1 if os.environ.get("SINEW_WEB") == "required" else SKIPPED
    if name == "unit":
        types = node("node_modules/typescript/bin/tsc", "--noEmit")
        return types or node("node_modules/vitest/vitest.mjs", "run")
    if name == "built":
        return is_built()
    return node("--test", f"browser/{name}.test.mjs")


if __name__ == "__main__":
    sys.exit(main(sys.argv))
