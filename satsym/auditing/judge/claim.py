"""Judgement of claims: whether the proposition of a row is true, and whether the reason that it gives is true.

If the proposition is false, it is also judged what else the row names as its origin.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import Any

from satsym.auditing import measurements
from satsym.auditing.comparison.bench import Bench
from satsym.auditing.ledger.contents import Row
from satsym.auditing.outcome import Outcome
from satsym.auditing.propositions.evaluation import Answer, Evaluation
from satsym.auditing.propositions.reading import Proposition, matching, proposition
from satsym.auditing.propositions.relations import Fit
from satsym.auditing.sentences import Said, property_in_indonesian
from satsym.formula.budget import OverBudget
from satsym.formula.values import Matrix, Relation
from satsym.formula.writing import written
from satsym.status import BadInput
from satsym.symbolic.lookup import formulas
from satsym.wording import refuse_unknown, shown


def judge(bench: Bench, row: Row) -> Outcome:
    """Return the outcome of a row that states a proposition."""
    assert row.claims is not None
    pages = Pages(bench, row)
    found = pages.answer(row.claims)
    reason = pages.answer(row.because) if row.because is not None and found.truth else None
    produced = pages.answer(row.produced) if row.produced is not None and found.truth is False else None
    deciding = next((answer for answer in (reason, produced) if answer is not None), found)
    sound = reason is None or reason.truth is not False
    said = "; ".join(dict.fromkeys((*found.reasons, *deciding.reasons)))
    return Outcome(
        row,
        found.truth,
        said,
        sound=sound,
        vacuous=bool(found.truth) and found.vacuous,
        artefact=produced is not None and bool(produced.truth),
        near=found.miss is Fit.NEAR,
        unit=found.miss is Fit.UNIT,
        remark="" if found.truth and sound and not found.vacuous else pages.explained(),
        evidence={**found.evidence, **deciding.evidence},
    )


class Pages:
    """The document in which the proposition of a row looks up other rows, texts and symbols."""

    def __init__(self, bench: Bench, row: Row) -> None:
        self._bench, self._row = bench, row

    def answer(self, proposition: Proposition) -> Answer:
        """Return whether a proposition is true.

        The answer is cached if the proposition does not depend on the document.
        """
        if proposition.stands_alone:
            return _alone(proposition.text)
        try:
            return self._evaluation.answer(proposition)
        except OverBudget:
            raise
        except BadInput as error:
            if not proposition.quotes:
                raise
            return Answer(None, (str(error),))  # letters that stand there may make no sense

    def explained(self) -> Said:
        """Return the explanation for readers, with the values of its terms filled in."""
        english = self._filled(self._row.why, str, " and ")
        return Said(english, self._filled(self._row.why_id, property_in_indonesian, " dan "))

    def _filled(self, why: tuple[str | Proposition, ...], written: Callable[[str], str], last: str) -> str:
        return "".join(part if isinstance(part, str) else written(self._evaluation.term(part, last)) for part in why)

    @cached_property
    def _evaluation(self) -> Evaluation:
        looked = {"row": self.row, "text": self.text, "meanings": self.meanings, "symbol": self.symbol}
        lookups = {**looked, "items": lambda _: self._bench.ledger.document.numbers}
        words = measurements.words(self._bench.scope(self._row).meanings)
        return Evaluation(words, lookups, _listed(self._row.table.printed))

    def row(self, key: str) -> Any:
        """Return the printed formula of a row in the names of the models; of an equation, the right-hand side."""
        refuse_unknown("there is no row", key, self._bench.rows)
        other = self._bench.rows[key]
        if other.printed is None:
            raise BadInput(f"row {key} contains no formula; write text['{key}'] for the text of this row")
        return _exact(self._bench.of_row(other))

    def text(self, key: str) -> Any:
        """Return the printed text of a row, or of all rows whose keys begin alike if the key ends in a star."""
        found = [_listed(row.table.printed) for name, row in self._bench.rows.items() if matching(key)(name)]
        if not found:
            refuse_unknown("there is no row", key, self._bench.rows)
        return found if key.endswith("*") else found[0]

    def symbol(self, name: str) -> Any:
        """Return the meaning of a symbol of the notation."""
        _, engine = self._bench.engines(self._row)
        return _exact(engine.value(self._bench.scope(self._row).meanings[name]))

    def meanings(self, letter: str) -> list[str]:
        """Return all meanings of a letter in the notations of the document; a letter without meaning is an error."""
        scopes = self._bench.ledger.scopes
        found = {scope.meanings[letter] for scope in scopes.values() if letter in scope.meanings}
        if not found:
            raise BadInput(f"no notation of the ledger has the symbol {shown(letter)}")
        return sorted(map(written, found))


@lru_cache(maxsize=4096)
def _alone(text: str) -> Answer:
    words = measurements.words()
    return Evaluation(words).answer(proposition(text, words))


def _listed(printed: Any) -> Any:
    return list(printed) if isinstance(printed, tuple) else printed


def _exact(found: Any) -> Any:
    if isinstance(found, Relation):
        return _exact(found.rhs)
    return formulas.matrix_of(found.rows) if isinstance(found, Matrix) else found
