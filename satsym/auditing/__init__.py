"""The audit: each claim of a document receives a verdict by comparison with what is derived."""

from satsym.auditing.judged import VERDICTS, Judged
from satsym.auditing.ledger.contents import Ledger
from satsym.auditing.ledger.documents import locate, refuse_unknown_items, shipped
from satsym.auditing.ledger.load import read
from satsym.auditing.run import audit

__all__ = ["VERDICTS", "Judged", "Ledger", "audit", "locate", "read", "refuse_unknown_items", "shipped"]
