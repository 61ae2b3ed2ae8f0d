"""Sinew: soft tissue as a mass-spring system on tetrahedral meshes.

    import sinew

    scene = sinew.Scene()
    scene.body("beam", shape="beam", cells=[4, 4, 16], young=150e3, poisson=0.45)
    scene.pin("wall", select={"side": "-z"})
    scene.probe("tip", select={"side": "+z"})
    sim = sinew.static(scene)
    print(sim.probes["tip"].displacement)  # [m]

Units are SI everywhere. Start with Scene, Simulation and run(); help() has the rest.
"""

from ._sinew import version as __version__
from . import report, study
from .calibration import Calibration, Estimate, calibrate, read_curve
from .errors import (DivergedError, Error, InputError, InternalError, IoError, UnstableError,
                     UsageError)
from .handles import (Blade, Body, ContactPoint, CutReport, Event, Grab, Material, Motion, Obstacle,
                      Pin, Pose, Probe, Wrench)
from .live import View, view
from .scene import Scene
from .simulation import Simulation
from .tasks import (ConvergeResult, LawIdentity, Moduli, RunResult, Trend, ValidateResult,
                    converge, identify, read_table, resume, run, static, validate)

__all__ = [
    "Blade", "Body", "Calibration", "ContactPoint", "ConvergeResult", "CutReport", "DivergedError", "Error",
    "Estimate", "Event", "Grab", "InputError", "InternalError", "IoError", "LawIdentity",
    "Material", "Moduli", "Motion", "Obstacle", "Pin", "Pose", "Probe", "RunResult", "Scene",
    "Simulation", "Trend", "UnstableError", "UsageError", "ValidateResult", "View", "Wrench",
    "__version__", "calibrate", "converge", "identify", "read_curve", "read_table", "report",
    "resume", "run", "static", "study", "validate", "view",
]
