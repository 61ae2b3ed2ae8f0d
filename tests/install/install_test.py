"""Sinew as others take it: the examples are built outside the tree and run.

    install_test.py installed    `cmake --install` of this build, moved elsewhere: the program; the
                                 shared library by find_package, pkg-config and ctypes, and the
                                 symbols that it shows; the archive by find_package
    install_test.py host         FetchContent and add_subdirectory in a host's build, static and
                                 shared: configured, and the lowest rooms built

Environment (ctest sets it): SINEW_BUILD, SINEW_VERSION, CMAKE, CXX, LAUNCHER.
"""

import json
import os
import pathlib
import re
import shutil
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests" / "support"))
from commands import check, run  # noqa: E402

BUILD = pathlib.Path(os.environ["SINEW_BUILD"])
CMAKE = os.environ.get("CMAKE", "cmake")
CXX = os.environ.get("CXX", "g++")
EXAMPLES = ("hello", "tool_in_a_loop", "own_mesh", "two_worlds", "in_c")
ABI = ROOT / "tests" / "install" / "abi.txt"
NUMBER = r"(-?\d+(?:\.\d+)?)"
# Other libraries' headers that a program with Sinew does not need.
INSIDE = ("eigen", "tbb", "fmt", "hwy", "pugixml", "toml", "xxhash", "nlohmann")
# What our own build adds and a user's may not get.
OUR_FLAGS = ("-Wconversion", "-Wshadow", "-ffp-contract", "-fvisibility", "EIGEN_")


# ---- what the examples print ----

def check_hello(text):
    sags = [float(m[1]) for m in re.finditer(rf"^\d\.\d s: +{NUMBER} mm$", text, re.M)]
    check(len(sags) == 10 and all(-30.0 < s < -1.0 for s in sags), f"the block sags:\n{text}")


def check_tool_in_a_loop(text):
    rows = [[float(x) for x in re.findall(NUMBER, line)] for line in text.splitlines()[1:]]
    check(len(rows) == 200 and all(len(row) == 9 for row in rows), f"200 rows of 9:\n{text}")
    pressed, drawn = rows[99], rows[199]
    check(rows[0][2] == 0.0, f"no force before it touches:\n{text}")
    check(pressed[2] > 0.05 and pressed[8] > 0, f"pushed up by the tissue:\n{text}")
    check(drawn[1] < -0.01, f"held back by friction:\n{text}")
    check(abs(drawn[6]) > 1e-5, f"a torque about z:\n{text}")


def check_own_mesh(text):
    check(text.startswith("117 nodes, 288 tets, 48.0 cm3, 50.9 g\n"), f"the bar's numbers:\n{text}")
    sags = [float(m[1]) for m in re.finditer(rf"mm: +{NUMBER} mm", text)]
    check(len(sags) == 5 and sags[0] == 0.0 and sags == sorted(sags, reverse=True) and
          sags[-1] < -1.0, f"the bar bends:\n{text}")


def check_two_worlds(text):
    check(len(set(re.findall(r": ([0-9a-f]{16})$", text, re.M))) == 2, f"two hashes:\n{text}")
    check(text.endswith("alone: the same bits\n"), text)


def check_in_c(text):
    match = re.fullmatch(rf"0\.050 s: {NUMBER} N on the ball, the slab {NUMBER} mm deep\n", text)
    check(match and float(match[1]) > 0.01 and 3.0 < float(match[2]) < 5.0, text)


def check_by_ctypes(text):
    lows = [float(m) for m in re.findall(rf"the lowest of 125 nodes at {NUMBER} mm", text)]
    check(len(lows) == 5 and min(lows) < lows[0] < -50.0, f"it sags:\n{text}")
    check("-1" in text.splitlines()[-1], f"the error's text:\n{text}")


def run_examples(find, env=None):
    """Runs those whose program find(name) gives, and checks what they print."""
    for name in EXAMPLES:
        globals()[f"check_{name}"](run(find(name), env=env))


# ---- ways to take Sinew ----

def by_find_package(prefix, folder):
    """The examples as a user builds them: copied away, with find_package alone."""
    folder.mkdir()
    sources, build = folder / "examples", folder / "build"
    shutil.copytree(ROOT / "examples", sources)
    run(CMAKE, "-G", "Ninja", "-S", sources, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}",
        f"-DCMAKE_CXX_COMPILER={CXX}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
        "-DCMAKE_FIND_PACKAGE_NO_PACKAGE_REGISTRY=ON", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
    for entry in json.loads((build / "compile_commands.json").read_text()):
        command = entry["command"]
        if not entry["file"].endswith(".c"):
            check(re.search(r"-std=(c|gnu)\+\+2[0-9a-z]", command), f"C++20 comes along: {command}")
        for flag in OUR_FLAGS:
            check(flag not in command, f"{flag} stays ours: {command}")
        check(str(ROOT) not in command, f"nothing of the source tree: {command}")
    run(CMAKE, "--build", build)
    run_examples(lambda name: build / name / name)
    # The folder of one example alone is a project, too.
    run(CMAKE, "-G", "Ninja", "-S", sources / "hello", "-B", folder / "one",
        f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_COMPILER={CXX}")


def by_pkg_config(prefix, folder):
    if not shutil.which("pkg-config"):
        raise SystemExit("no pkg-config here: ./dev setup test")
    found = list(prefix.rglob("sinew.pc"))
    check(len(found) == 1, f"one sinew.pc in {prefix}: {found}")
    env = {"PKG_CONFIG_PATH": str(found[0].parent)}
    check(run("pkg-config", "--modversion", "sinew", env=env).strip() ==
          os.environ["SINEW_VERSION"], "the version of sinew.pc")
    flags = run("pkg-config", "--cflags", "--libs", "sinew", env=env).split()
    program = folder / "hello-by-pkg-config"
    run(CXX, "-std=c++20", ROOT / "examples" / "hello" / "hello.cpp", "-o", program, *flags)
    libraries = {"LD_LIBRARY_PATH": str(found[0].parent.parent)}
    check_hello(run(program, env=libraries))


def check_headers(prefix, folder):
    """Each public header compiles alone, without warnings and without other libraries."""
    include = prefix / "include"
    for header in sorted((include / "sinew").glob("*.h")):
        source = folder / f"only_{header.stem}.cpp"
        source.write_text(f"#include <sinew/{header.name}>\n")
        run(CXX, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow",
            "-Wconversion", "-Werror", "-I", include, source)
        paths = run(CXX, "-std=c++20", "-M", "-I", include, source).replace("\\\n", " ").split()
        if header.name in ("sinew.h", "capi.h"):  # of C, too
            run(CXX.replace("g++", "gcc"), "-std=c99", "-fsyntax-only", "-Wall", "-Wextra",
                "-Wpedantic", "-Werror", "-x", "c", "-I", include, source)
        for path in paths:
            check(not any(part.startswith(INSIDE) for part in pathlib.Path(path).parts[2:-1]),
                  f"{header.name} needs {path}")


def check_symbols(prefix):
    """libsinew.so shows what the public headers mark SINEW_API, and nothing else. None of the
    symbols of its binary interface (abi.txt) is missing."""
    marked = set()
    for header in (prefix / "include" / "sinew").glob("*.h"):
        text = header.read_text()
        marked |= set(re.findall(r"class SINEW_API (\w+)", text))
        marked |= set(re.findall(r"^SINEW_API [^;(]*?(\w+)\(", text, re.M))
    library = next(iter(prefix.rglob("libsinew.so")))
    shown = run("nm", "-D", "--defined-only", "-C", library).splitlines()
    check(len(shown) > 20, f"it shows something: {shown}")
    for line in shown:
        name = line.split(maxsplit=2)[2]
        match = re.match(r"(?:(?:typeinfo|typeinfo name|vtable) for )?sinew::(\w+)", name)
        match = match or re.fullmatch(r"(sinew_\w+)", name)  # of C
        check(match and match[1] in marked, f"{name} is not of the interface ({sorted(marked)})")
    known, soname = ABI.read_text().split(), re.search(r"\[libsinew\.so\.(\d+)\]",
                                                     run("readelf", "-d", library))
    check(soname and soname[1] == known[0], f"its SONAME is that of {ABI}")
    symbols = {line.split()[2] for line in run("nm", "-D", "--defined-only", library).splitlines()}
    if os.environ.get("SINEW_UPDATE_ABI"):
        ABI.write_text("\n".join([soname[1], *sorted(symbols)]) + "\n")
        return
    gone, new = set(known[1:]) - symbols, symbols - set(known[1:])
    check(not gone, f"programs that were linked before need {sorted(gone)}: raise SINEW_ABI in "
          "cmake/SinewLibrary.cmake, then SINEW_UPDATE_ABI=1 ctest -R install.installed")
    check(not new, f"{sorted(new)} are new: SINEW_UPDATE_ABI=1 ctest -R install.installed")


def check_program(prefix):
    version = run(prefix / "bin" / "sinew", "--version")
    check(os.environ["SINEW_VERSION"] in version, version)
    for name in ("bash-completion/completions/sinew", "zsh/site-functions/_sinew",
                 "fish/vendor_completions.d/sinew.fish"):
        check((prefix / "share" / name).is_file(), f"share/{name}")


def archive_by_find_package(prefix, folder):
    """The archive, for a program that carries everything in itself."""
    folder.mkdir()
    shutil.copy(ROOT / "examples" / "hello" / "hello.cpp", folder)
    (folder / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(hello LANGUAGES CXX)\n"
        "find_package(Sinew CONFIG REQUIRED COMPONENTS static)\n"
        "add_executable(hello hello.cpp)\n"
        "target_link_libraries(hello PRIVATE Sinew::sinew_static)\n")
    run(CMAKE, "-G", "Ninja", "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={prefix}",
        f"-DCMAKE_CXX_COMPILER={CXX}")
    run(CMAKE, "--build", folder / "build")
    check("libsinew" not in run("ldd", folder / "build" / "hello"), "it carries the library")
    check_hello(run(folder / "build" / "hello"))


def installed(folder):
    run(CMAKE, "--install", BUILD, "--prefix", folder / "first")
    prefix = folder / "moved" / "sinew"  # the package may lie anywhere
    prefix.parent.mkdir()
    (folder / "first").rename(prefix)
    check_program(prefix)
    check_headers(prefix, folder)
    check_symbols(prefix)
    by_find_package(prefix, folder / "find_package")
    archive_by_find_package(prefix, folder / "archive")
    by_pkg_config(prefix, folder)
    library = next(iter(prefix.rglob("libsinew.so.0")))
    check_by_ctypes(run(sys.executable, ROOT / "examples" / "by_ctypes" / "by_ctypes.py", library))


def host(folder):
    sources = ROOT / "tests" / "install" / "host"
    for way in ("subdirectory", "fetched"):
        for shared in ("OFF", "ON"):
            build = folder / f"{way}-{shared}"
            # Plain code: the interface is looked at here, not the speed.
            run(CMAKE, "-G", "Ninja", "-S", sources, "-B", build, f"-DSINEW_SOURCE={ROOT}",
                f"-DBUILD_SHARED_LIBS={shared}", f"-DEXAMPLES={ROOT / 'examples'}",
                f"-DBY={way}", f"-DSINEW_INSTALL={shared}", f"-DCMAKE_CXX_COMPILER={CXX}",
                "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O0")
            plan = (build / "build.ninja").read_text()
            for library, wanted in (("libsinew.so", shared == "ON"), ("libsinew.a", shared == "OFF")):
                check((f"{library}" in plan) == wanted, f"{way}, shared {shared}: {library}")
            check(way == "subdirectory" or "examples/hello/hello" in plan, "the examples")
    run(CMAKE, "--build", build, "--target", "sinew_mesh")


def main(argv):
    kinds = {"installed": installed, "host": host}
    if len(argv) != 2 or argv[1] not in kinds:
        print(__doc__, file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory(prefix="sinew-install-") as folder:
        kinds[argv[1]](pathlib.Path(folder))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
