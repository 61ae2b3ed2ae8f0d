"""Reference values for Sinew's validation suite, by CalculiX and by analysis: see tools/referee.py."""
