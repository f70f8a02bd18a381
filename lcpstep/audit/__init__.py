"""Audits: which parts of a run are certainly free of events that it has not noticed."""

from lcpstep.audit.again import audited
from lcpstep.audit.certify import audit
from lcpstep.audit.result import Audit, Found, Window

__all__ = ["Audit", "Found", "Window", "audit", "audited"]
