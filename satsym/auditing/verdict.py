"""Verdicts on rows, from the outcomes of all rows of a document and the relations between them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from satsym.auditing.causes import SILENT, with_causes
from satsym.auditing.comparison.bench import Bench, Both
from satsym.auditing.comparison.compare import plans
from satsym.auditing.diagnosis.edits import Change, Edit
from satsym.auditing.judge.claim import Pages
from satsym.auditing.judge.formula import corrected, in_rows, shown
from satsym.auditing.judged import AS_STATED, Judged, Verdict
from satsym.auditing.ledger.contents import Row
from satsym.auditing.outcome import Outcome
from satsym.auditing.propositions.reading import shape
from satsym.auditing.propositions.values import in_words
from satsym.auditing.sentences import joined, say, sentence, stated
from satsym.formula import budget
from satsym.formula.tree import ONE, Formula, Mul, Neg, Node, Num, Sym, names_in
from satsym.formula.values import Kernel, Matrix, Relation, Roots
from satsym.formula.writing import written
from satsym.symbolic.lookup import formulas

FORMULAS = ("equation", "matrix")
"""Kinds of rows that can be misprints; lines of programs and numbers are wrong instead."""


def verdicts(bench: Bench, outcomes: Sequence[Outcome], wanted: Sequence[str] | None = None) -> list[Judged]:
    """Return the verdicts on some rows, by default all, from the outcomes of all rows in order."""
    by_key = {outcome.row.key: outcome for outcome in outcomes}
    context = _Context(bench, by_key)
    chosen = [o for o in outcomes if wanted is None or o.row.key in wanted]
    return with_causes([bench.within(budget.VERDICT, o.row, partial(context.judged, o)) for o in chosen])


class _Context:
    """Relations between the rows of a document."""

    def __init__(self, bench: Bench, outcomes: Mapping[str, Outcome]) -> None:
        self._bench = bench
        self._outcomes = outcomes
        self._right: dict[str, Formula] = {}
        self._known: dict[tuple[str, tuple[str, ...]], bool] = {}

    def judged(self, outcome: Outcome) -> Judged:
        verdict, sayings = self._verdict(outcome)
        said = joined(sayings if verdict != "confirmed" else ())
        row, document = outcome.row, self._bench.ledger.document.key
        command = f'satsym audit {self._bench.ledger.name} --item "{row.key}"'
        why = sentence(self._why(outcome) if verdict not in SILENT else "")
        numbers = "; ".join(f"{name} = {in_words(value)}" for name, value in outcome.evidence.items())
        return Judged(
            document=document,
            **{name: getattr(row.table, name) for name in AS_STATED},
            says_id=row.says_id,
            derived=shown(outcome.plan, None) if outcome.plan and self._takes_over(outcome) else outcome.derived,
            verdict=verdict,
            diagnosis=str(said),
            diagnosis_id=said.indonesian,
            evidence=f"{numbers}; {command}" if numbers else command,
            why=str(why),
            why_id=why.indonesian,
            by_formula=row.claims is None,
            form=_form(outcome),
            vacuous=outcome.vacuous,
            spoiled_by=tuple(self._spoiled_by(outcome)) if verdict not in SILENT else (),
        )

    def _why(self, outcome: Outcome) -> str:
        """Return the explanation for readers of a row; for a claim it is part of the outcome."""
        row = outcome.row
        return outcome.remark if row.claims is not None else Pages(self._bench, row).explained()

    def _verdict(self, outcome: Outcome) -> tuple[Verdict, list[str]]:
        row = outcome.row
        if not row.table.legible:
            return "illegible", [stated(say("unread"), row.says)]
        if row.claims is not None:
            return self._of_claim(outcome)
        if outcome.unit:
            return "unit error", [outcome.remark]
        if not outcome.right and row.table.kind in FORMULAS:
            return self._of_wrong_formula(outcome)
        if not outcome.right:
            return "imprecise" if outcome.near else "wrong", [outcome.remark]
        if row.follows is not None and not self._follows(row, {}) and not self._follows_once_corrected(row):
            instead = self._instead(row)
            return "unsound", [joined([say("unsound", row.uses), say("instead", instead) if instead else "", "."], "")]
        return "confirmed", []

    def _of_claim(self, outcome: Outcome) -> tuple[Verdict, list[str]]:
        derived, remark = outcome.derived, sentence(outcome.remark)
        if outcome.right is None:
            return "undecided", [say("undecided", derived)]
        if outcome.right:
            if outcome.vacuous:
                return "unsound", [say("vacuous_claim", derived), remark]
            return ("confirmed", []) if outcome.sound else ("unsound", [say("unsound_claim", derived), remark])
        if outcome.artefact:
            return "artefact", [say("artefact", derived), remark]
        if outcome.row.table.kind == "unit":
            return "unit error", [stated(say("denied"), derived), remark]
        by_role: dict[str, Verdict] = {"citation": "misprint", "notation": "notation"}
        verdict = by_role.get(outcome.row.table.role, "wrong")
        verdict = "imprecise" if outcome.near else "unit error" if outcome.unit else verdict
        return verdict, [stated(say("denied"), derived), remark]

    def _of_wrong_formula(self, outcome: Outcome) -> tuple[Verdict, list[str]]:
        row = outcome.row
        same = [o for o in self._outcomes.values() if o is not outcome and self._bench.same_target(o.row, row)]
        right_elsewhere = [o.row.key for o in same if o.right]
        slips = [o.row.key for o in same if o.right is False and o.remedy and _same(o, outcome)]
        carried, corrected = self._used_by(row)
        verdict: Verdict = "wrong" if carried else "misprint"
        source = self._spoiled_by(outcome)
        takes_over = self._takes_over(outcome)
        return verdict, [
            outcome.remark if not takes_over else say("takes_over", source),
            say("right_elsewhere", right_elsewhere) if right_elsewhere else "",
            say("follows_from_wrong", source) if source and not takes_over else "",
            say("carried_on", carried) if carried else "",
            say("not_carried_on", corrected) if corrected else "",
            say("same_slip", slips) if slips else "",
        ]

    def _spoiled_by(self, outcome: Outcome) -> list[str]:
        """Return the keys of faulty rows that a faulty row follows from."""
        row = outcome.row
        if row.claims is not None:
            return [key for key in row.uses if self._outcomes[key].right is False]
        return self._wrong_among(row.uses) if row.follows is not None and self._follows(row, {}) else []

    def _used_by(self, row: Row) -> tuple[list[str], list[str]]:
        """Return the rows that carry the error of a row on, and the rows that follow only from its right formula."""
        carried, corrected = [], []
        for other in self._outcomes.values():
            if row.key in other.row.uses and other.plan is not None:
                as_printed = self._follows(other.row, {})
                put_right = self._follows(other.row, {row.key: self._corrected(row.key)})
                if as_printed and not put_right:
                    carried.append(other.row.key)
                elif put_right and not as_printed:
                    corrected.append(other.row.key)
        return carried, corrected

    def _follows_once_corrected(self, row: Row) -> bool:
        wrong = self._wrong_among(row.uses)
        return bool(wrong) and self._follows(row, {key: self._corrected(key) for key in wrong})

    def _takes_over(self, outcome: Outcome) -> bool:
        """Return whether a formula is wrong only because it follows, as printed, from faulty rows."""
        row = outcome.row
        source = self._spoiled_by(outcome) if row.claims is None and outcome.right is False else []
        if not source:
            return False
        right = {key: self._corrected(key) for key in source}
        found, target = (
            value.rhs if isinstance(value, Relation) else value
            for value in (self._bench.follows(row, right).exact, self._bench.target(row).exact)
        )
        if isinstance(found, Matrix) and isinstance(target, Matrix) and found.shape == target.shape:
            pairs = zip(found.entries, target.entries, strict=True)
            return all(formulas.is_zero(one - other) for one, other in pairs)
        no_formula = (Roots, Kernel, Matrix)
        if isinstance(found, no_formula) or isinstance(target, no_formula):
            return False
        return formulas.is_zero(found - target)

    def _wrong_among(self, keys: Sequence[str]) -> list[str]:
        """Return the keys of formulas that differ from their targets."""
        return [key for key in keys if self._outcomes[key].plan is not None and not self._outcomes[key].right]

    def _follows(self, row: Row, replacements: Mapping[str, Formula]) -> bool:
        """Return whether a row follows from the rows that it refers to, some of them replaced."""
        asked = row.key, tuple(replacements)
        if asked not in self._known:
            work = partial(self._follows_from, row, replacements)
            self._known[asked] = self._bench.within(budget.VERDICT, row, work, "from")
        return self._known[asked]

    def _instead(self, row: Row) -> str:
        """Return what follows from the rows that a row refers to, in the document's symbols.

        It is empty if it is no formula.
        """
        both = self._bench.follows(row)
        found = both.exact.rhs if isinstance(both.exact, Relation) else both.exact
        if isinstance(found, Roots | Kernel) or not both.has_a_value:
            return ""
        lines = found.rows if isinstance(found, Matrix) else ((found,),)
        trees = tuple(tuple(self._bench.theirs(row, formulas.to_tree(entry)) for entry in line) for line in lines)
        return in_rows(trees) if isinstance(found, Matrix) else written(trees[0][0])

    def _follows_from(self, row: Row, replacements: Mapping[str, Formula]) -> bool:
        assert row.printed is not None
        value = self._bench.follows(row, replacements)
        nothing = isinstance(value.trees, Roots | Kernel) and not isinstance(row.printed, tuple)
        if nothing or not value.has_a_value:
            return False
        if isinstance(value.exact, Relation) and self._only_names(row, value.exact):
            value = Both(value.trees.rhs, value.exact.rhs)  # what is named follows, not 0 = 0
        ways = plans(self._bench, row, row.printed, value)
        return any(way.may_hold(way.printed) and way.is_right(way.printed) for way in ways)

    def _only_names(self, row: Row, relation: Relation[Any]) -> bool:
        """Return whether a relation only defines a name that the row does not write in another form."""
        used = {name for key in row.uses for name in self._defined_in(self._bench.rows[key])}
        return formulas.is_zero(relation.lhs - relation.rhs) and not used & self._defined_in(row)

    def _defined_in(self, row: Row) -> set[str]:
        """Return the letters of a row that stand for an expression."""
        meanings = self._bench.scope(row).meanings
        return {name for name in names_in(row.printed) if not isinstance(meanings.get(name, ONE), Sym | Num)}

    def _corrected(self, key: str) -> Formula:
        if key not in self._right:
            self._right[key] = corrected(self._outcomes[key])
        return self._right[key]


def _same(one: Outcome, other: Outcome) -> bool:
    """Return whether two rows are corrected by the same edits."""
    mine, others = ([(e.change, e.old, e.new) for _, e in o.remedy.edits] if o.remedy else [] for o in (one, other))
    return bool(mine) and mine == others


def _form(outcome: Outcome) -> str:
    """Return the text that rows with the same fault share: the form of a claim, or the edits or unit of a formula."""
    if outcome.row.claims is not None:
        return shape(outcome.row.claims.tree)
    if outcome.remedy is None:
        return outcome.lacks if outcome.unit else ""
    return "; ".join(sorted({_change(edit) for _, edit in outcome.remedy.edits}))


def _change(edit: Edit) -> str:
    """Return what an edit does, independent of its place; for a missing or superfluous factor, the factor."""
    if edit.change in (Change.DROPPED_FACTOR, Change.MISSING_FACTOR):
        old, new = (Counter(written(f) for f in _factors(part) if f != ONE) for part in (edit.old, edit.new))
        return f"{edit.change.name} {' * '.join((old - new) | (new - old))}"
    if edit.change is Change.MEAN:
        return edit.change.name
    return f"{edit.change.name} {written(edit.old)} -> {written(edit.new)}"


def _factors(node: Node) -> tuple[Node, ...]:
    if isinstance(node, Neg):
        return _factors(node.operand)
    return tuple(f for factor in node.factors for f in _factors(factor)) if isinstance(node, Mul) else (node,)
