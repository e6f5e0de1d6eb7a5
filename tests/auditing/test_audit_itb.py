"""The ledger of itb_eigen: every verdict other than confirmed is reached a second time, and every line is judged."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.integrate

from satsym import auditing as audit
from satsym.auditing import cache
from satsym.auditing.program import run as program_run
from satsym.auditing.program import text as program
from tests.support import itb_routes as routes
from tests.support.itb_routes import MU, R0, ROUTES, V0, YEAR, rows

UNREAD = {"figure 1.1", "figure 2.1", "figure 3.1", "figure 3.2", "III kick"}
"""Pictures, and a number that is garbled."""


@pytest.fixture(scope="module")
def verdicts():
    return {row.key: row.verdict for row in cache.audit(audit.read(audit.locate("itb_eigen")))}


@pytest.fixture(scope="module")
def walked():
    return program_run.run(program.read(routes.whole(rows())))


@pytest.mark.parametrize("key", ROUTES)
def test_a_second_route_finds_fault_with_it_too(key):
    assert ROUTES[key](rows(), key) != "confirmed"


@pytest.mark.slow
def test_the_audit_and_the_second_routes_agree(verdicts):
    found = {key: verdict for key, verdict in verdicts.items() if verdict != "confirmed"}
    assert {key for key, verdict in found.items() if verdict == "illegible"} == UNREAD
    assert set(found) - UNREAD == set(ROUTES)
    assert {key: route(rows(), key) for key, route in ROUTES.items()} == {key: found[key] for key in ROUTES}


def test_every_number_of_the_document_has_a_row():
    assert audit.read(audit.locate("itb_eigen")).uncovered() == []


def test_every_line_of_the_program_is_judged_by_itself_or_in_its_function():
    """Beside the row that prints the whole."""
    judged = set()
    for key, row in rows().items():
        if key.startswith("program ") and key != "program lines":
            for text in (row["printed"], row.get("original", "")):
                judged |= {str(line).strip() for line in ([text] if isinstance(text, str) else np.ravel(text))}
    numbers = {"M_sun = 1.989e30", "G = 6.67430e-11", "mu = G * M_sun"}
    left = {line.strip() for line in routes.whole(rows())} - judged
    assert left <= numbers
    assert {f"program {line.split(' =')[0]}" for line in numbers} <= set(rows())


def test_the_pieces_are_the_whole_program_but_for_what_is_found_fault_with():
    whole, pieces = routes.whole(rows()), routes.pieces(rows())
    assert set(pieces) - set(whole) == {"def calculate_jacobian(r, v):"}
    lacking = {line for line in whole if line not in pieces}
    assert lacking == {"def calculateJacobi(r, v):", "x, y, z = solution.y[:3]", rows()["program solution"]["printed"]}


def test_the_program_is_walked_through_as_python_would_run_it(walked):
    """Against the same computation, written by hand."""

    def rates(_, y):
        return [*y[3:], *(-MU * y[:3] / np.linalg.norm(y[:3]) ** 3)]

    times = np.linspace(0.0, YEAR, 1000)
    start = np.array([R0, 0.0, 0.0, 0.0, V0, 0.0])
    done = scipy.integrate.solve_ivp(rates, (0.0, YEAR), start, t_eval=times, rtol=1e-9, atol=1e-12)
    x, y = (walked.values[name] for name in "xy")
    np.testing.assert_allclose(np.hypot(x - done.y[0], y - done.y[1]) / R0, 0.0, atol=1e-9)
    exact = np.sqrt(MU / R0**3) * np.array([np.sqrt(2.0), 1j, 1j, -1j, -1j, -np.sqrt(2.0)])
    found = np.sort_complex(walked.values["eigenvalues"] * 1e7)
    np.testing.assert_allclose(found, np.sort_complex(exact * 1e7), rtol=1e-12, atol=1e-9)
    assert walked.said[-1] == "Is the system stable? No"


def test_energy_and_place_are_kept_as_the_evidence_says(walked):
    """Against the orbit by Kepler's equation, solved here."""
    solution = walked.values["solution"].attributes
    t, y = solution["t"], solution["y"]
    energy = 0.5 * (y[3:] ** 2).sum(axis=0) - MU / np.linalg.norm(y[:3], axis=0)
    axis = -0.5 * MU / energy[0]
    e, pace = 1.0 - R0 / axis, np.sqrt(MU / axis**3)
    # it starts at an apsis, the farther one where e is negative
    anomaly = pace * t
    for _ in range(50):
        anomaly -= (anomaly - e * np.sin(anomaly) - pace * t) / (1.0 - e * np.cos(anomaly))
    place = np.array([axis * (np.cos(anomaly) - e), axis * np.sqrt(1.0 - e**2) * np.sin(anomaly)])
    assert 1e-9 < np.abs(energy / energy[0] - 1.0).max() < 5e-9
    assert 300.0 < np.linalg.norm(place - y[:2], axis=0).max() < 2000.0


@pytest.mark.slow
@pytest.mark.parametrize(
    "key",
    ["program d2x_dx", "program d2y_dz", "listing 5 d2z_dx", "program ax", "program orbitalEquation",
     "program calculateJacobi", "II.2 gravity gradient", "II.1.b equation of motion", "program solution",
     "II.4 negative", "II.4 positive", "II.4 zero", "program r0", "program v0", "program one year"],
)  # fmt: skip
def test_what_is_right_is_confirmed(verdicts, key):
    assert verdicts[key] == "confirmed"
