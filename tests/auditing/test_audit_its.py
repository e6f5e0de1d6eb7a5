"""The ledgers of the ITS documents: every verdict other than confirmed is reached a second time, by hand."""

from __future__ import annotations

import re

import pytest
import sympy as sp

from satsym import auditing as audit
from satsym.auditing import cache
from satsym.auditing.causes import findings
from satsym.report.said import spoken
from satsym.report.terminal.audit import audit_text
from satsym.report.texts import languages
from tests.support import its_claim_routes as claims
from tests.support import its_routes as by_hand
from tests.support import its_sweep_routes as sweeps
from tests.support.its_claim_routes import units
from tests.support.its_routes import Route, rows

UNREAD = {
    "its_thesis": {"figure 2.1", "figure 2.3", "figure 2.4", "figure 3.1", "section 2.4 angle vector"},
    "its_paper": {"II figure 1", "II figure 2"},
}
"""Pictures, and a line of which the text has lost all marks."""

WITH_CONTROL = {"r": (2, 6, 10), "r_dot": (3, 7, 11), "theta": (4, 8, 12), "theta_dot": (5, 9, 13)}
LETTERS = {
    "x1": ("r - sigma", "r"),
    "x3": ("sigma*(theta - omega*t)", "theta"),
    "x4": ("sigma*(theta_dot - omega)", "theta_dot"),
    "lambda1": ("lam", "lambda1"),
    "theta": ("theta", "omega*t"),
    "u1": ("r_dot", "u1"),
    "f": ("f1", "f2"),
    "x": ("r", "u1"),
}
returned = claims.returned("r", "r_dot", "theta_dot")

ROUTES: dict[str, dict[str, Route]] = {
    "its_thesis": {
        "abstract gravity": claims.gravity,
        "abstract returns": returned,
        "abstract control": claims.halved_guess,
        "abstract cost": claims.halved_guess,
        "section 1.1 geostationary": claims.ellipse,
        "section 2.2 geostationary": claims.ellipse,
        "section 2.3.3 coverage": claims.polar_caps,
        "section 1.1 gravity": claims.gravity,
        "section 2.4 gravity": claims.gravity,
        "section 2.4.3 reference": by_hand.one_force_alone,
        "section 2.7 type 5, start": by_hand.varied_start,
        "section 3.2 eigenvalues decide": claims.driven_oscillator,
        "section 4.1.1 characteristic function": by_hand.matrix_itself,
        **{f"2.19 {part}": sweeps.inconsistent for part in ("k2", "k3", "k4", "order")},
        "section 4.1 equilibrium, r": by_hand.one_of_many_circles,
        "section 4.1 equilibrium": by_hand.steady_motion,
        "4.19": by_hand.from_zero_differences,
        "4.22 first x": by_hand.written_out_state,
        "section 4.1.3 CA3, left factor": by_hand.left_factor,
        "section 4.2 same system": by_hand.two_systems,
        "4.27": by_hand.angular_rate,
        "section 4.2 weights": units("newton*s*s/m", "joule/(m/s**2)**2/s"),
        "section 4.2 bounds": claims.unreachable,
        "section 4.2 aim": claims.left_alone,
        "section 4.2 reference": claims.beyond_the_last,
        "section 4.3 H* within the bounds": by_hand.beyond_the_bounds,
        "section 4.4 reference, costates": by_hand.two_of_four,
        "section 4.5 reference": by_hand.one_force_alone,
        "section 4.5 within 60 s": claims.too_fast,
        "figure 4.13 reference": claims.other_weights,
        "4.28": by_hand.thesis_hamiltonian,
        "4.35": by_hand.state_equation,
        "section 4.4 truncation error": sweeps.fifth_power,
        "section 4.4 step 2, length": claims.one_too_few,
        "section 4.4 step 4, before the states": sweeps.zero_over_zero,
        "section 4.4 step 6, lambda3": sweeps.index_slip,
        **{f"section 4.4 step 6, k{k} of lambda{i}": sweeps.frozen_states for k in (2, 3, 4) for i in (1, 2, 4)},
        **{f"section 4.4 step 5, k{k} of x{i}": sweeps.frozen_controls for k in (2, 3, 4) for i in (2, 4)},
        "section 4.4 order forwards": sweeps.frozen_controls,
        "section 4.4 order backwards": sweeps.frozen_states,
        "section 4.5 same system": by_hand.two_systems,
        "table 4.1": claims.not_earth,
        "section 4.5 x1(0)": by_hand.no_displacement,
        "section 4.5 x4(t)": by_hand.no_displacement,
        **{f"section 4.5 J for {a} and {b}": claims.halved_guess for a, b in ((50, 10), (10, 50), (10, 10), (50, 50))},
        **{
            f"figure 4.{n} with control": claims.returned(state)
            for state, figures in WITH_CONTROL.items()
            for n in figures
        },
        "table 4.2": claims.halved_guess,
        "section 4.5 least J": claims.proportional,
        "section 4.5 u1 = u2 = 0.005": claims.halved_guess,
        **{f"notation {letter}": by_hand.two_meanings(*pair) for letter, pair in LETTERS.items()},
        "section 5.1 1, unstable": by_hand.defective,
        "section 5.1 3, returns": returned,
        "section 5.1 3, cost": claims.halved_guess,
        "section 5.1 3, effort": claims.effort,
        "appendix A g": units("km**5/s**2", "km**3/s**2"),
        "appendix A G": units("newton*m/kg**2", "m**3/s**2/kg"),
        "appendix A x3 as in section 4.1": units("degree", "km"),
        "appendix A x4 as in section 4.1": units("degree/s", "km/s"),
        "appendix A J": units("joule", "newton*s*s/m*(m/s**2)**2*s"),
        "appendix A angles": claims.degrees,
        "appendix A force": claims.force,
        "appendix B u2s": sweeps.least_squares,
        "appendix B while": sweeps.backward_test,
        "appendix B oldu1": sweeps.guess_for_ever,
        **{f"appendix B initial, {v}{k}": sweeps.line_of_the_listing for v in "abed" for k in (2, 3, 4)},
        **{f"appendix B state, k{k}_x{i}s": sweeps.line_of_the_listing for i in range(1, 5) for k in (2, 3, 4)},
        **{f"appendix B costate, k{k}_l{i}": sweeps.line_of_the_listing for i in (1, 2, 4) for k in (2, 3, 4)},
        **{f"appendix B {loop} loop": sweeps.first_order_loop for loop in ("initial", "state", "costate")},
        "appendix B x4s(i+1) too early": sweeps.not_yet_defined,
    },
    "its_paper": {
        "abstract gravity": claims.gravity,
        "abstract returns": returned,
        "abstract control": claims.halved_guess,
        "abstract weights": units("newton*s*s/m", "joule/(m/s**2)**2/s"),
        "abstract cost": claims.halved_guess,
        "section I gravity": claims.gravity,
        "II (9) state": by_hand.canonical_state,
        "II (14) time": by_hand.end_on_a_curve,
        "II (15) start": by_hand.varied_start,
        **dict.fromkeys(("II (19)", "II (20)", "II (21)", "section II.D order"), sweeps.inconsistent),
        "III (12)": by_hand.angular_rate,
        "section III.A characteristic function": by_hand.matrix_itself,
        "section III.A theorems": claims.no_theorems,
        "section III.D bounds": claims.unreachable,
        "section III.D aim": claims.left_alone,
        "section III.D H*": by_hand.controls_left,
        "III (14)": by_hand.paper_hamiltonian,
        "III (18)": by_hand.state_equation,
        "section III.E step 2, length": claims.one_too_few,
        "section III.E reference, states": claims.one_too_early,
        "section III.E reference, costates": claims.one_too_early,
        "section III.F within 60 s": claims.too_fast,
        "section III.E step 4, before the states": sweeps.zero_over_zero,
        "section III.F x1(0)": by_hand.no_displacement,
        "section III.F x4(0)": by_hand.no_displacement,
        **{f"III figure {n} with control": claims.returned(s) for n, s in enumerate(by_hand.STATES, start=2)},
        "table 1": claims.halved_guess,
        "section III.F least J": claims.proportional,
        "section III.F u1 = u2 = 0.005": claims.halved_guess,
        **{
            f"notation {letter}": by_hand.two_meanings(*pair)
            for letter, pair in LETTERS.items()
            if letter not in ("u1", "f", "x")
        },
        "section IV 1, unstable": by_hand.defective,
        "section IV 3, returns": returned,
        "section IV 3, cost": claims.halved_guess,
        "section IV 3, effort": claims.effort,
    },
}
"""Document -> row -> the route that judges it a second time."""

CASES = [(document, key) for document, routes in ROUTES.items() for key in routes]


@pytest.fixture(scope="module")
def judged() -> dict[str, list[audit.Judged]]:
    """What the audit finds."""
    return {document: cache.audit(audit.read(audit.locate(document))) for document in ROUTES}


@pytest.mark.parametrize(("document", "key"), CASES, ids=[f"{d}: {k}" for d, k in CASES])
def test_a_second_route_finds_fault_with_it_too(document, key):
    assert ROUTES[document][key](rows(document), key) != "confirmed"


@pytest.mark.slow
def test_the_audit_and_the_second_routes_agree(judged, sample):
    """No false alarm: whatever is not confirmed has a route, and the route reaches the same verdict."""
    for document, routes in ROUTES.items():
        found = {row.key: row.verdict for row in judged[document] if row.verdict != "confirmed"}
        assert {key for key, verdict in found.items() if verdict == "illegible"} == UNREAD[document]
        assert set(found) - UNREAD[document] == set(routes)
        reached = {key: route(rows(document), key) for key, route in sample(routes.items())}
        assert {key: found[key] for key in reached} == reached


@pytest.mark.slow
@pytest.mark.parametrize("language", languages())
def test_the_report_of_the_thesis_can_be_read(judged, language, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    assert len(findings(judged["its_thesis"])) <= 40
    with spoken(language):
        text = audit_text([audit.read(audit.locate("its_thesis"))], judged, language=language)
    assert len(text.splitlines()) <= 170  # with the chart of what stands, and the places of quotations
    assert max(map(len, text.splitlines())) <= 100


@pytest.mark.parametrize("document", ROUTES)
def test_every_number_of_the_document_has_a_row(document):
    assert audit.read(audit.locate(document)).uncovered() == []


def test_lines_of_the_listing_that_are_confirmed_are_the_textbook_s():
    document = rows("its_thesis")
    lines = {key for key, row in document.items() if row.get("scope") == "listing"}
    assert len(lines) == 72
    for key in lines - set(ROUTES["its_thesis"]):
        assert sweeps.line_of_the_listing(document, key) == "confirmed"


def test_formulas_of_the_listing_are_the_printed_lines():
    """What is judged is MATLAB's line in the notation of the ledger, where x1s_i1 is x1s(i+1)."""
    listed = [row for row in rows("its_thesis").values() if row.get("scope") == "listing"]
    assert listed
    for row in listed:
        line = re.sub(r"\((\w)(?:\+(1))?\)", r"_\1\2", row["original"].rstrip(";"))
        name, _, formula = sweeps.python(line).partition("=")
        assert name == row["printed"].partition(" = ")[0]
        assert by_hand.same(sp.sympify(formula), by_hand.formula(row))
