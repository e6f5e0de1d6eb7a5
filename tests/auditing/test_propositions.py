"""The language of claims: what may be written, when it is true, and what decides it."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable
from typing import Any

import pytest

from satsym.auditing import measurements
from satsym.auditing.propositions.evaluation import Answer, Evaluation
from satsym.auditing.propositions.reading import Words, explanation, is_proposition, proposition, shape
from satsym.auditing.propositions.relations import Fit, fit
from satsym.auditing.propositions.values import Family, Record, Undecided
from satsym.auditing.quantities import in_base_units, printed_number
from satsym.status import BadInput

PAGE: dict[str, Callable[[str], Any]] = {
    "row": {"a": 3.0}.__getitem__,
    "text": {"a": ["line 1", "line 2"]}.__getitem__,
    "symbol": {"s": 5.0}.__getitem__,
    "meanings": {"s": ["r", "r - sigma"]}.__getitem__,
    "items": lambda _: ["2.1", "theorem 3"],
}
"""A document with one row and one letter."""


def unknown() -> float:
    """A measurement without an answer."""
    raise Undecided("it was not measured")


MEMBERS = Family("NUMBERS", "numbers", tuple(Record(f"n = {n}", {"n": n}) for n in (1, 2, 3)))
WORDS = Words(
    {"unknown": unknown, "double": lambda x: 2 * x, "length": lambda: in_base_units("1500 m")},
    {"NUMBERS": lambda: MEMBERS, "NEAR": lambda: 0.05},
    ("s",),
)


def answer(text: str) -> Answer:
    return Evaluation(WORDS, PAGE, ("a", "b")).answer(proposition(text, WORDS, own=True))


TRUE = [
    "1 < 2 <= 2", "double(2) == 4", "not 1 == 2", "implies(1 == 2, unknown() == 1)", "iff(1 == 2, 2 == 3)",
    "all(m.n < 4 for m in NUMBERS)", "any(m.n == 2 for m in NUMBERS)", "all(m.n != 2 for m in NUMBERS if m.n > 2)",
    "row['a'] == s - 2", "text['a'] == ['line 1', 'line 2']", "meanings['s'] == ['r', 'r - sigma']", "'2.1' in items",
    "printed == ['a', 'b']", "length() == '1.5 km'", "length() < '2 km'", "0.1 + 0.2 == 0.3",
    "double(0.0755) == '0.15'",
    "unknown() == 1 or 1 == 1", "[1, 2] == [1, 2]", "all(a < b for a, b in [[1, 2], [2, 3]])", "double(s) == 10",
]  # fmt: skip
FALSE = [
    "1 < 2 < 2", "double(2) != 4", "implies(1 == 1, 1 == 2)", "iff(1 == 1, 1 == 2)", "all(m.n < 3 for m in NUMBERS)",
    "any(m.n > 3 for m in NUMBERS)", "1 == 2 and unknown() == 1", "double(0.0805) == '0.15'", "[1, 2] == [1, 2, 3]",
    "length() == '1.4 km'", "'2.2' in items", "any(m.n == 9 for m in NUMBERS) or 1 == 2",
]  # fmt: skip


@pytest.mark.parametrize("text", TRUE)
def test_true_and_its_negation_false(text: str) -> None:
    assert answer(text).truth is True
    assert answer(f"not ({text})").truth is False


@pytest.mark.parametrize("text", FALSE)
def test_false_and_its_negation_true(text: str) -> None:
    assert answer(text).truth is False
    assert answer(f"not ({text})").truth is True


@pytest.mark.parametrize("text", ["unknown() == 1", "unknown() == 1 and 1 == 1", "implies(1 == 1, unknown() == 1)",
                                  "iff(unknown() == 1, 1 == 1)", "all(unknown() == m.n for m in NUMBERS)",
                                  "all(n < 9 for n in [unknown(), 1])", "any(n == 1 for n in [1, unknown()])",
                                  "all(m.n < 9 for m in NUMBERS if unknown() == 1)"])  # fmt: skip
def test_what_cannot_be_measured_is_undecided_either_way(text: str) -> None:
    for asked in (text, f"not ({text})"):
        found = answer(asked)
        assert found.truth is None
        assert "it was not measured" in " ".join(found.reasons)


def test_an_answer_names_what_refutes_and_what_was_measured() -> None:
    found = answer("all(double(m.n) < 5 for m in NUMBERS)")
    assert found.reasons == ("double(m.n) = 6 (n = 3)",)
    assert answer("double(2) == 5").evidence == {"double(2)": "4"}


def test_a_universal_that_no_member_meets_is_vacuous() -> None:
    assert answer("all(implies(m.n > 9, m.n == 1) for m in NUMBERS)").vacuous
    assert not answer("all(implies(m.n > 2, m.n == 3) for m in NUMBERS)").vacuous
    assert answer("all(m.n == 1 for m in NUMBERS if m.n > 9)").vacuous


@pytest.mark.parametrize(
    ("text", "vacuous"),
    [  # members that meet one condition need not meet the other, but each has to be met by one
        ("all(implies(m.n < 2, m.n == 1) and implies(m.n > 2, m.n == 3) for m in NUMBERS)", False),
        ("all(implies(m.n < 2, m.n == 1) and implies(m.n > 9, m.n == 3) for m in NUMBERS)", True),
        ("all(implies(m.n < 2, m.n == 1) for m in NUMBERS) and all(implies(m.n > 9, m.n == 3) for m in NUMBERS)", True),
        ("1 == 1 and all(implies(m.n > 9, m.n == 3) for m in NUMBERS)", True),
        ("1 == 1 or all(implies(m.n > 9, m.n == 3) for m in NUMBERS)", False),
        ("all(implies(m.n > 9, m.n == 3) for m in NUMBERS) or 1 == 1", False),
        ("all(implies(m.n > 9, m.n == 3) for m in NUMBERS) or 1 == 2", True),
        ("all(all(implies(m.n > k, m.n > 1) for m in NUMBERS) for k in [1, 9])", False),
        ("any(implies(m.n > 9, m.n == 3) for m in NUMBERS)", False),
    ],
)
def test_each_condition_of_a_sentence_has_to_be_met_by_something(text: str, vacuous: bool) -> None:
    found = answer(text)
    assert found.truth
    assert found.vacuous is vacuous


def test_an_equivalence_is_said_of_the_larger_of_two_families() -> None:
    universal = "all(m.n < 4 for m in NUMBERS)"
    members = answer(universal).members
    assert members > 1
    assert [answer(f"iff({one})").members for one in (f"{universal}, 1 == 1", f"1 == 1, {universal}")] == [members] * 2


def test_what_is_vacuous_names_the_condition_that_nothing_meets() -> None:
    found = answer("all(implies(m.n < 2, m.n == 1) and implies(m.n > 9, m.n == 3) for m in NUMBERS)")
    assert found.reasons == ("none of 3 numbers satisfies the condition m.n > 9",)


@pytest.mark.parametrize(
    ("value", "printed", "how"),
    [
        (0.1449, "0.15", Fit.NEAR), (0.1451, "0.15", Fit.INSIDE), (0.1599, "0.15", Fit.INSIDE),
        (0.1601, "0.15", Fit.NEAR), (0.1701, "0.15", Fit.OUTSIDE), (-0.1599, "-0.15", Fit.INSIDE),
        (-0.1449, "-0.15", Fit.NEAR),
        (35786.0, "36000", Fit.INSIDE), (35400.0, "36000", Fit.NEAR), (1.0e-7, "0.0000001", Fit.INSIDE),
    ],
)  # fmt: skip
def test_printed_digits_stand_for_what_rounds_or_is_cut_to_them(value: float, printed: str, how: Fit) -> None:
    assert fit(value, printed_number(printed)) is how


def test_a_last_digit_off_is_near_only_where_all_that_fails_is_near() -> None:
    assert answer("double(0.0722) == '0.15'").miss is Fit.NEAR
    assert answer("double(0.0722) == '0.15' and 1 == 2").miss is None
    assert answer("not double(0.0722) == '0.15'").miss is None


def test_what_is_off_by_the_factor_of_a_unit_is_told_from_what_is_wrong() -> None:
    assert answer("length() == 0.001*length()").miss is Fit.UNIT
    assert answer("length() == 3*length()").miss is None
    assert answer("length() == -0.001*length()").miss is None


BAD = {
    "__import__('os').system('true')": "given by its name",
    "double.__globals__": "is not a permitted attribute",
    "double == 1": "is a measurement",
    "s.__class__ == 1": "is not a permitted attribute",
    "lambda: 1": "lambda",
    "[x for x in NUMBERS][0].n == y": "is unknown",
    "double(1, 2) == 3": "arguments",
    "doubel(1) == 3": "unknown",
    "all(1 == 1, 2)": "comprehension",
    "implies(1 == 1)": "two propositions",
    "f'{s}' == '5'": "not allowed here",
    "all(m.n < 3 for NUMBERS in NUMBERS)": "new name",
    "row[1] == 2": "in quotes",
    "meanings[s] == 2": "one quoted symbol",
    "1 == 1; 2": "not allowed here",
    "1 ==": "not a proposition",
    "double(**s) == 1": "not allowed",
    "(" * 60 + "1" + ")" * 60 + " == 1": "deep",
    "": "empty",
}


@pytest.mark.parametrize("text", BAD)
def test_what_is_no_proposition_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(BadInput, match=BAD[text]) as caught:
        proposition(text, WORDS)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("double(2)", "neither true nor false"),
        ("s.n == 1", "has no attributes"),
        ("all(m.k == 1 for m in NUMBERS)", "has no"),
        ("length() == 3 + length()", "no value"),
        ("length() == '2 s'", "cannot be measured in"),
        ("2 ** 1000 == 1", "at most"),
        ("all(m == 1 for m in s)", "must be a family or a list"),
        ("text['a'][7] == 'x'", "no such entry"),
    ],
)
def test_terms_that_make_no_sense_together_are_refused(text: str, why: str) -> None:
    with pytest.raises(BadInput, match=why):
        answer(text)


def test_a_formula_is_no_proposition() -> None:
    assert is_proposition("a == b")
    assert is_proposition("not a")
    assert is_proposition("all(x == 1 for x in S)")
    assert not is_proposition("charpoly(A, lam) = 0")
    assert not is_proposition("polar_orbit:first_order.r")
    assert not is_proposition("A + B")


def test_a_sentence_holds_terms_in_braces() -> None:
    first, term, last = explanation("it is {double(2)}, no more", WORDS)
    assert (first, last) == ("it is ", ", no more")
    assert not isinstance(term, str)
    assert Evaluation(WORDS, PAGE).term(term) == "4"
    with pytest.raises(BadInput, match="brace"):
        explanation("it is {double(2)", WORDS)


def test_the_shape_of_a_claim_forgets_its_names_and_numbers() -> None:
    one, other = (ast.parse(t, mode="eval").body for t in ("double(row['a'].n) < 5", "double(row['b'].k) < 0.1"))
    assert shape(one) == shape(other) != shape(ast.parse("double(row['a'].n) > 5", mode="eval").body)


def test_measurements_see_neither_what_is_printed_nor_a_verdict() -> None:
    words = measurements.words()
    for name, function in words.functions.items():
        parameters = inspect.signature(function).parameters
        assert not {"row", "printed", "verdict", "document"} & parameters.keys(), name
        yes_or_no = inspect.signature(function).return_annotation in ("bool", bool)
        assert parameters or not yes_or_no, f"{name} is a claim, not a measurement"
        assert function.__doc__, f"{name} says nothing of itself"
