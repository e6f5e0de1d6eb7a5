"""What the papers print, with a slip planted in a row: the row is confirmed no longer; put right, it is."""

from __future__ import annotations

import tomllib

import pytest

from satsym.auditing import audit, read
from tests.support import ledgers

PROGRAM = {  # row: what stands there, and what is planted
    "listing 1 lines": ("import eig", "import eigh"),
    "listing 4 lines": ("r**3", "r**2"),
    "listing 5 lines": ("3 * mu * z**2", "3 * mu * y**2"),
    "listing 5 identity": ("[:3, 3:]", "[3:, 3:]"),
    "listing 6 y0": ("(r0, v0)", "(v0, r0)"),
    "listing 6 one year": ("3.154", "3.174"),
    "listing 6 t_span": ("3.154e7", "3.1e7"),
    "listing 6 t_eval": ("1000", "999"),
    "listing 7 eig": ("eigenvalues, eigenvectors", "eigenvectors, eigenvalues"),
    "listing 7 print eigenvalues": ("{eigenvalues}", "{jacobian}"),
    "listing 7 print stability": ("'Yes' if", "'No' if"),
    "listing 8 frame": ('"equal"', '"tight"'),
    "listing 8 Sun": ("[0], [0]", "[1e11], [0]"),
    "program imports": ("import numpy as np", "import numpy as xp"),
    "program orbitalEquation": ("[vx, vy", "[vy, vx"),
    "program calculateJacobi": ("d2z_dx = d2x_dz", "d2z_dx = d2x_dy"),
    "program solution": ("rtol=1e-9", "rtol=1e-1"),
    "program x, y, z": ("x, y, z", "x, z, y"),
    "program jacobian": ("(r0, v0)", "(v0, r0)"),
}
WHOLE = {
    "program lines": ("eig(jacobian)", "eig(jacob)"),
    "listing 3 lines": ("G * M_sun", "G + M_sun"),
    "listing 6 lines": ("v0 = np.array([0, 29.78e3, 0])", "v0 = np.array([29.78e3, 0, 0])"),
}
RIGHT = {
    "listing 7 calculateJacobi": ("calculateJacobi", "calculate_jacobian"),
    "listing 8 label": ("Stable Orbit", "Orbit"),
    "listing 8 x axis": ("x / 1e11", "x / 149597870700"),
    "program y axis": ("y (AU)", "y (Gm)"),
}
DIVISOR = {"program y axis": ("1e11", "1e9")}


PITCH = {
    "7 left-hand side": ("2*zeta", "zeta"),
    "12 command": ("P_c/s", "P_c/s**2"),
    "21": ("C2 - C1*tau", "C1*tau - C2"),
}
# signs that the scan hardly shows, read the other way: the derived equations hold for none of these
READ_OTHERWISE = {
    **{f"4 {state}": ("w0*(I_wy - 2*I_wx) + H_b", "-(w0*(I_wy - 2*I_wx) + H_b)") for state in ("g_z_dot", "psi_dot")},
    **{f"5 {state}": ("-(w0", "(w0") for state in ("g_x_dot", "phi_dot")},
    "3": ("- I_wy*d_Omega", "+ I_wy*d_Omega"),
    "6": ("d_Omega - theta_ddot", "d_Omega + theta_ddot"),
}
PITCH_RIGHT = {
    "24 torque": ("I_wy*d_Omega", "I_wy*d_Omega*(1 - I_wy/I_y)"),
    "29 limits": ("(C1*tau - C2 + C_p*X2)/(2*(tau*C_p - 1))", "(C2 - C1*tau)/2"),
}


def _changed(printed: object, old: str, new: str) -> object:
    if isinstance(printed, list):
        return [_changed(entry, old, new) for entry in printed]
    return str(printed).replace(old, new)


def _verdicts(tmp_path, document, *slips):
    text = ledgers.whole(document)
    changed = {f"{row['item']} {row.get('part', '')}".strip(): row for row in tomllib.loads(text)["row"]}
    for planted in slips:
        for key, (old, new) in planted.items():
            before = changed[key]["printed"]
            changed[key]["printed"] = _changed(before, old, new)
            assert changed[key]["printed"] != before
    path = ledgers.write(tmp_path, list(changed.values()), text[: text.index("[[row]]")])
    keys = [key for planted in slips for key in planted]
    return {row.key: row.verdict for row in audit(read(path), keys) if row.key in keys}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("document", "planted"),
    [("itb_eigen", PROGRAM), ("itb_eigen", WHOLE), ("lapan_pitch", PITCH | READ_OTHERWISE)],
    ids=["lines", "programs", "pitch"],
)
def test_a_slip_in_what_is_printed_is_noticed(tmp_path, sample, document, planted):
    planted = dict(sample(planted.items()))
    found = _verdicts(tmp_path, document, planted)
    assert set(found) == set(planted)
    assert [key for key, verdict in found.items() if verdict == "confirmed"] == []


@pytest.mark.slow
@pytest.mark.parametrize(("document", "planted"), [("itb_eigen", (RIGHT, DIVISOR)), ("lapan_pitch", (PITCH_RIGHT,))])
def test_what_is_put_right_is_confirmed(tmp_path, document, planted):
    found = _verdicts(tmp_path, document, *planted)
    assert set(found.values()) == {"confirmed"}


@pytest.mark.slow
@pytest.mark.parametrize(("source", "verdict"), [("d2x_dz", "confirmed"), ("r_norm", "unsound"), ("d2x_dy", "unsound")])
def test_what_a_name_stands_for_follows_from_no_other_name(tmp_path, source, verdict):
    """Each line says what a name stands for, so that both are 0 = 0 once the names are put in."""
    text, key = ledgers.whole("itb_eigen"), "program d2z_dx"
    rows = {f"{row['item']} {row.get('part', '')}".strip(): row for row in tomllib.loads(text)["row"]}
    rows[key]["from"] = f"row['program {source}']"
    path = ledgers.write(tmp_path, list(rows.values()), text[: text.index("[[row]]")])
    assert {row.key: row.verdict for row in audit(read(path), [key])}[key] == verdict
