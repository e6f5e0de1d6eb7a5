"""The audit: what documents print, held against what is derived, row by row."""

from satsym.audit.documents import locate, refuse_unknown_items, shipped
from satsym.audit.judged import VERDICTS, Judged
from satsym.audit.ledger import Ledger
from satsym.audit.load import read
from satsym.audit.run import audit

__all__ = ["VERDICTS", "Judged", "Ledger", "audit", "locate", "read", "refuse_unknown_items", "shipped"]
