"""The packages of build/packages, tried as their users would.

    package_test.py contents    what lies in each Debian package
    package_test.py debian      all of them in an empty Debian: the program, the view, the mesher, man
                                pages, a plot from Python, the tests of the Python package, a study,
                                programs in C and C++ that link the library
    package_test.py tarball     the tarball in an empty Debian, before anything else is there
    package_test.py wheel       the source archive is whole, and can be configured; `pip wheel` of it
                                with the module of this build, and tests of the package with it.
                                SINEW_PACKAGES=full compiles the module anew, 6 minutes

`./dev package` makes them first. Without them a test is skipped; with SINEW_PACKAGES=required it
fails. A machine that cannot make an empty Debian (root, a mirror) skips those that need one.
Environment (ctest sets it): SINEW_VERSION, SINEW_BUILD.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests" / "support"))
from commands import check, run  # noqa: E402

PACKAGES = ROOT / "build" / "packages"
VERSION = os.environ.get("SINEW_VERSION", "*")
SKIPPED = 77
PYTHON_TESTS = ("scene", "simulation", "tasks", "study", "study_command", "calibrate")
# What the tests read beside themselves.
NEEDED = ("tests/python", "scenes", "validation", "examples", "README.md", "docs")


class Skipped(Exception):
    pass


class Unable(Skipped):
    """This machine cannot make a root of its own, whatever is required."""


def packages(pattern):
    found = sorted(PACKAGES.glob(pattern.replace("VERSION", VERSION)))
    if not found:
        raise Skipped(f"no {pattern} in {PACKAGES}: ./dev package")
    return found


# ---- an empty Debian ----

def sources():
    """The package sources of this machine, so that its mirror is asked."""
    folder = pathlib.Path("/etc/apt")
    files = [folder / "sources.list", *sorted((folder / "sources.list.d").glob("debian*.sources"))]
    return [path for path in files if path.exists() and path.read_text().strip()]


class Debian:
    """An empty Debian of this machine's release, in a folder that is removed at the end."""

    def __init__(self):
        if not shutil.which("mmdebstrap"):
            raise Skipped("no mmdebstrap here: ./dev setup package")
        if os.getuid() != 0:
            raise Unable("only root can make an empty Debian")
        release = re.search(r"^VERSION_CODENAME=(\S+)", pathlib.Path("/etc/os-release").read_text(),
                            re.M)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="sinew-debian-"))
        self.folder.chmod(0o755)
        self.root = self.folder / "root"
        try:
            run("mmdebstrap", "--quiet", "--variant=apt", release[1], self.root, *sources())
            for name in ("proc", "dev"):
                run("mount", "--rbind", "--make-rslave", f"/{name}", self.root / name)
        except SystemExit as why:
            self.__exit__()
            raise Unable(f"no empty Debian here: {why}") from None
        (self.root / "usr/sbin/policy-rc.d").write_text("#!/bin/sh\nexit 101\n")
        (self.root / "usr/sbin/policy-rc.d").chmod(0o755)
        (self.root / "try").mkdir()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for name in ("proc", "dev"):
            subprocess.run(["umount", "--recursive", "--lazy", self.root / name], check=False)
        shutil.rmtree(self.folder, ignore_errors=True)

    def sh(self, script, cwd="/try"):
        """What a shell script in there prints."""
        environment = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LC_ALL": "C.UTF-8",
                       "DEBIAN_FRONTEND": "noninteractive", "PYTHONDONTWRITEBYTECODE": "1",
                       "MPLBACKEND": "Agg"}
        return run("env", "-i", *(f"{name}={value}" for name, value in environment.items()),
                   "chroot", self.root, "/bin/sh", "-euc", f"cd {cwd}\n{script}")

    def install(self, *names):
        for conf in pathlib.Path("/etc/apt/apt.conf.d").glob("*"):  # a proxy, for one
            if "proxy" in conf.read_text(errors="replace").lower():
                shutil.copy(conf, self.root / "etc/apt/apt.conf.d")
        self.sh("apt-get update -qq; apt-get install -y -qq --no-install-recommends "
                + " ".join(names))

    def copy(self, path, to="try"):
        (self.root / to).mkdir(parents=True, exist_ok=True)
        target = self.root / to / pathlib.Path(path).name
        if pathlib.Path(path).is_dir():
            shutil.copytree(path, target, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(path, target)


def readme_commands(debian, sinew, scenes):
    """The two commands of the README: run the liver, show it."""
    said = debian.sh(f"{sinew} run {scenes}/liver.toml --set duration=0.2")
    check("out/liver" in said and "energy" in said, said)
    check((debian.root / "try/out/liver/liver.pvd").exists(), "the run's folder")
    # The server without a browser: the page and its policy.
    page = debian.sh(textwrap.dedent(f"""
        {sinew} view {scenes}/liver.toml --port 8123 > view.txt 2>&1 & view=$!
        for i in $(seq 100); do grep -q http view.txt && break; sleep 0.1; done
        perl -e 'use IO::Socket::INET;
          $s = IO::Socket::INET->new("127.0.0.1:8123") or die "no server";
          print $s "GET / HTTP/1.1\\r\\nHost: 127.0.0.1:8123\\r\\nConnection: close\\r\\n\\r\\n";
          local $/; print <$s>'
        kill -INT $view; wait $view || [ $? = 130 ]"""))
    check("200 OK" in page and "<title>Sinew</title>" in page, page[:2000])


# ---- the tests ----

EXPECTED = {
    "sinew": ["./usr/bin/sinew", "./usr/share/man/man1/sinew.1.gz",
              "./usr/share/man/man1/sinew-run.1.gz",
              "./usr/share/bash-completion/completions/sinew",
              "./usr/share/applications/sinew.desktop", "./usr/share/mime/packages/sinew.xml",
              "./usr/share/sinew/scenes/liver.toml"],
    "libsinew0": [r"./usr/lib/[^/]+/libsinew\.so\.0"],
    "libsinew-dev": ["./usr/include/sinew/sinew.h", "./usr/include/sinew/capi.h",
                     r"./usr/lib/[^/]+/libsinew\.a", r"./usr/lib/[^/]+/libsinew\.so",
                     r"./usr/lib/[^/]+/pkgconfig/sinew\.pc",
                     r"./usr/lib/[^/]+/cmake/Sinew/SinewConfig\.cmake"],
    "python3-sinew": ["./usr/lib/python3/dist-packages/sinew/__init__.py",
                      r"./usr/lib/python3/dist-packages/sinew/_sinew\.[^/]+\.so",
                      "./usr/lib/python3/dist-packages/sinew/py.typed"],
    "sinew-mesh": ["./usr/bin/sinew-mesh", "./usr/share/man/man1/sinew-mesh.1.gz"],
}


def contents():
    for name, expected in EXPECTED.items():
        package, = packages(f"{name}_VERSION-*.deb")
        files = [line.split()[5] for line in run("dpkg-deb", "-c", package).splitlines()]
        for file in [*expected, f"./usr/share/doc/{name}/copyright",
                     f"./usr/share/doc/{name}/changelog.Debian.gz"]:
            check(any(re.fullmatch(file, have) for have in files), f"{name} has {file}: {files}")
        # The core is Apache-2.0: nothing under the GPL is linked into it.
        if name != "sinew-mesh":
            needs = run("dpkg-deb", "-f", package, "Depends")
            check(not re.search(r"gmp|mpfr|cgal", needs), f"{name} needs {needs}")


def debian():
    found = packages("*_VERSION-*.deb")
    with Debian() as there:
        for package in found:
            there.copy(package, "packages")
        # What the Python package recommends and suggests, for its tests.
        there.install("/packages/*.deb", "python3-matplotlib", "python3-scipy",
                      "python3-distributed", "python3-h5py")
        readme_commands(there, "sinew", "/usr/share/sinew/scenes")
        there.sh("sinew validate uniaxial --dir /usr/share/sinew/validation --quick")
        for path in NEEDED:
            there.copy(ROOT / path, pathlib.Path("src") / pathlib.Path(path).parent)
        plot = re.search(r"<!-- plot -->\n```python\n(.*?)```",
                         (ROOT / "docs/python.md").read_text(), re.S)[1]
        check(len(plot.strip().splitlines()) <= 10, "a plot in ten lines")
        (there.root / "try/plot.py").write_text(plot)
        there.sh("ln -s /usr/share/sinew/scenes scenes; python3 plot.py")
        picture = there.root / "try/tip.png"
        check(picture.exists() and picture.stat().st_size > 5000, "a plot of the liver's tip")
        for name in PYTHON_TESTS:
            there.sh(f"python3 /src/tests/python/{name}_test.py")
        there.sh("sinew-mesh /usr/share/sinew/scenes/meshes/bowl.off -o bowl.msh; sinew info bowl.msh")
        there.sh("sinew study --help; sinew calibrate --help; zcat /usr/share/man/man1/sinew-run.1.gz")
        there.install("g++", "cmake", "ninja-build", "pkg-config")
        there.sh("""cmake -G Ninja -S /src/examples -B build > /dev/null; cmake --build build
                    build/hello/hello; build/in_c/in_c; build/own_mesh/own_mesh
                    python3 /src/examples/by_ctypes/by_ctypes.py libsinew.so.0
                    g++ -std=c++20 /src/examples/hello/hello.cpp -o hello \\
                      $(pkg-config --cflags --libs sinew); ./hello""")
        there.sh("apt-get purge -y -qq 'libsinew*' sinew python3-sinew; ! command -v sinew")


def tarball():
    archive, = packages("sinew-VERSION-linux-x86_64.tar.gz")
    with Debian() as there:
        there.copy(archive)
        folder = there.sh(f"tar xzf {archive.name}; ls -d sinew-*/").strip().rstrip("/")
        missing = [line for line in there.sh(f"ldd {folder}/bin/sinew").splitlines()
                   if "not found" in line]
        check(not missing, missing)
        readme_commands(there, f"{folder}/bin/sinew", f"{folder}/share/sinew/scenes")


def wheel():
    archive, = packages("sinew-VERSION.tar.gz")
    python = "/usr/bin/python3"
    with tempfile.TemporaryDirectory(prefix="sinew-wheel-") as folder:
        run("tar", "xzf", archive, "-C", folder)
        unpacked, = pathlib.Path(folder).glob("sinew-*")
        if (ROOT / ".git").exists():
            for name in run("git", "-C", ROOT, "ls-files").splitlines():
                check((unpacked / name).exists() or not (ROOT / name).exists(), f"it has {name}")
        environment = {}
        if os.environ.get("SINEW_PACKAGES") == "full":  # plain code: the speed is not looked at
            environment["SINEW_CMAKE_ARGS"] = "-DCMAKE_CXX_FLAGS_RELEASE=-O0"
        else:
            run("cmake", "-G", "Ninja", "-S", unpacked, "-B", unpacked / "build",
                "-DSINEW_APPS=OFF", "-DSINEW_TESTS=OFF", "-DSINEW_PYTHON_PACKAGE=ON")
            environment["SINEW_CMAKE_BUILD"] = os.environ["SINEW_BUILD"]
        run(python, "-m", "pip", "wheel", "--no-index", "--no-deps", "--no-build-isolation",
            "--wheel-dir", folder, archive, env=environment)
        built = next(pathlib.Path(folder).glob("*.whl"))
        site = pathlib.Path(folder) / "site"
        run(python, "-m", "pip", "install", "--no-index", "--no-deps", "--target", site, built)
        run(python, ROOT / "tests/python/scene_test.py", cwd=folder,
            env={"PYTHONPATH": str(site)})


def main(argv):
    kinds = {"contents": contents, "debian": debian, "tarball": tarball, "wheel": wheel}
    if len(argv) != 2 or argv[1] not in kinds:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        kinds[argv[1]]()
    except Skipped as why:
        print(f"skipped: {why}")
        if isinstance(why, Unable):
            return SKIPPED
        return 1 if os.environ.get("SINEW_PACKAGES") in ("required", "full") else SKIPPED
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
