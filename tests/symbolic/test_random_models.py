"""Some of the random models of `make bench-models`: right ones are derived, generated and loaded, slips are refused."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from satsym.kernels import loading
from satsym.report import artefacts
from satsym.symbolic import derive, loader
from satsym.symbolic.convention import is_minimum
from tests.support import slips
from tests.support.random_models import random_model

QUICK = (0, 4, 6, 7, 9, 13, 19, 20, 998, 1012, 1713)
"""Models that take a second or two each, of several kinds."""


HARD = (481, 543, 555, 580, 623, 625, 628, 666, 753, 928, 973, 1011, 1062, 1141, 1196, 1265)
"""Models of which floats keep no digits, whose thresholds are crossed where powers are complex or positive states are
not, whose potential is an integral that only functions unknown here express, and such as sympy would simplify for
hours."""


@pytest.mark.slow
@pytest.mark.parametrize("seed", [*QUICK, *HARD])
def test_a_right_model_is_loaded_and_one_with_a_slip_is_not(seed: int, tmp_path: Path) -> None:
    path = tmp_path / f"stating_{seed}.py"
    path.write_text(random_model(seed).text(), encoding="utf-8")
    (subject,) = loader.load(path)
    derivation = derive(subject)
    made = artefacts.files(subject, lambda one: derivation if one is subject else derive(one), path, tmp_path)
    artefacts.write(made, tmp_path)
    assert loading.load(f"./{subject.name}", tmp_path).spec.name == subject.name
    rng, planted = random.Random(f"slips {seed}"), 0
    for _ in range(8):
        if (slip := slips.in_step(derivation, rng)) is not None:
            planted += slip.effect or bool(slip.caught)
            assert slip.caught or not slip.effect, slip
        if is_minimum(derivation):
            changed = slips.in_text(derivation, made[f"{subject.name}.py"], rng)
            planted += changed is not None and (changed[0].effect or bool(changed[0].caught))
            assert changed is None or changed[0].caught or not changed[0].effect, changed[0]
        if planted >= 4:
            break
    assert planted >= 2


def test_a_model_of_a_number_is_always_the_same_and_they_are_of_all_kinds() -> None:
    assert random_model(7).text() == random_model(7).text()
    assert {random_model(seed).kind for seed in range(200)} >= {"free", "box", "ball", "switching", "constrained"}
