"""Material parameters from measured force-displacement curves. docs/calibrate.md."""

from .fit import Calibration, Estimate, calibrate, read_curve

__all__ = ["Calibration", "Estimate", "calibrate", "read_curve"]
