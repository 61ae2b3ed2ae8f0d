"""python3 -m sinew.study FOLDER NUMBERS: does runs of a study, as a task of another engine."""

import pathlib
import sys

from .point import run_from_folder

if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    run_from_folder(pathlib.Path(sys.argv[1]), [int(n) for n in sys.argv[2].split(",") if n])
