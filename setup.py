"""Builds the extension module of the Python package by CMake, for `pip wheel .`.

SINEW_CMAKE_ARGS: further arguments of CMake, e.g. -DCMAKE_CXX_COMPILER=clang++.
SINEW_CMAKE_BUILD: a build folder of the same sources that has the module already.
"""

import os
import pathlib
import re
import shlex
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


def version():
    text = (ROOT / "include" / "sinew" / "version.h").read_text()
    return ".".join(re.findall(r"^#define SINEW_VERSION_[A-Z]+ (\d+)$", text, re.M))


class Build(build_ext):
    def build_extension(self, ext):
        have = os.environ.get("SINEW_CMAKE_BUILD")
        build = pathlib.Path(have or self.build_temp).resolve()
        if not have:
            self.make(build)
        target = pathlib.Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        module, = (build / "python" / "sinew").glob("_sinew.*.so")
        self.copy_file(str(module), str(target))

    @staticmethod
    def make(build):
        subprocess.run(
            ["cmake", "-G", "Ninja", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release",
             "-DSINEW_APPS=OFF", "-DSINEW_TESTS=OFF", "-DSINEW_PYTHON_PACKAGE=ON",
             f"-DSINEW_PYTHON={sys.executable}",
             *shlex.split(os.environ.get("SINEW_CMAKE_ARGS", ""))], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "sinew_python"], check=True)


setup(version=version(), ext_modules=[Extension("sinew._sinew", [])],
      cmdclass={"build_ext": Build})
