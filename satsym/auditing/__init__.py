"""The audit: each claim (row) that a document makes is compared with what is derived and receives a verdict."""

from satsym.auditing.judged import VERDICTS, Judged
from satsym.auditing.ledger.contents import Ledger
from satsym.auditing.ledger.documents import locate, refuse_unknown_items, shipped
from satsym.auditing.ledger.load import read
from satsym.auditing.run import audit

__all__ = ["VERDICTS", "Judged", "Ledger", "audit", "locate", "read", "refuse_unknown_items", "shipped"]
