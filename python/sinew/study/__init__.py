"""Parameter studies: a scene, ranges of its values, and one table of results.

    import sinew
    from sinew.study import Range, Study

    study = Study("liver.toml", {"liver.young": Range(2e3, 20e3, log=True),
                                 "liver.poisson": [0.4, 0.45, 0.49]})
    table = study.run("out/stiffness", design="latin", samples=50)
    table.column("left_tip.uy")            # [m] (runs)

A study is a folder. A run that is done stays done: after a kill, `run()` with the same arguments
does the rest. Every run takes one thread, and has the bits of `sinew run` alone.
"""

from .designs import Point, Range, design_of
from .engines import Dask, Engine, Local, Slurm
from .sensitivity import Effect, Morris, Sobol
from .study import Study
from .table import Table

__all__ = ["Dask", "Effect", "Engine", "Local", "Morris", "Point", "Range", "Slurm", "Sobol",
           "Study", "Table", "design_of"]
