"""The hard cases: every scene of the catalogue by every method that fits, measured against its known answer."""

from lcpstep.hard.check import Check, Row, run_check
from lcpstep.hard.methods import METHODS
from lcpstep.hard.table import CHECKS, table

__all__ = ["CHECKS", "METHODS", "Check", "Row", "run_check", "table"]
