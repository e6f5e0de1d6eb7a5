"""What can be said of a notation alone."""

from __future__ import annotations

from satsym.auditing import sentences
from satsym.auditing.ledger.scopes import ambiguities
from satsym.auditing.predicates import Finding, Question, predicate


@predicate
def one_meaning(*, symbol: str, row: Question) -> Finding:
    """Whether a document uses a symbol for one thing only, told from the scopes of its ledger."""
    meanings = ambiguities(row.scopes).get(symbol, {})
    listed = [f"`{meaning}` ({', '.join(scopes)})" for meaning, scopes in meanings.items()]
    evidence = {f"meaning {i}": meaning for i, meaning in enumerate(meanings, start=1)}
    if not meanings:
        return Finding(True, f"{symbol} has one meaning")
    return Finding(False, sentences.one_letter(symbol, listed), evidence)
