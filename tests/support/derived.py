"""Derivations made once for all tests that look into them: in all processes, and until the engine changes.

What is kept comes back equal in every part, or is not kept. Tests of the act of deriving call ``derive`` themselves.
"""

from __future__ import annotations

import hashlib
import io
import pickle
import shutil
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import sympy as sp
from _pytest.mark import ParameterSet

from satsym import source_files, user_cache
from satsym.report import stamps, texts
from satsym.report.latex.document import render
from satsym.symbolic import Derivation, Model, Problem, derive, loader
from satsym.symbolic.declared import identity

SHARE = 6
"""Every sixth shipped model is derived for tests of all of them, others after each change of the engine."""

_HOME = Path(__file__).resolve().parents[2] / ".pytest_cache" / "derivations"

_KNOWN: dict[str, Derivation] = {}
"""Derivations by the identity of what was stated."""

_THEMSELVES: list[tuple[Problem | Model, Derivation]] = []
"""What has no identity because it holds code of its own, with its derivation."""


def derived(subject: Problem | Model) -> Derivation:
    """The derivation of a problem or model; one that holds code of its own is known by itself, in this process."""
    key = identity(subject)
    if key and key not in _KNOWN:
        _KNOWN[key] = _kept(key) or _keep(key, derive(subject))
    return _KNOWN[key] if key else _itself(subject)


@cache
def names() -> tuple[str, ...]:
    """Of all that shipped derivation files state."""
    return tuple(one.name for path in loader.shipped() for one in loader.load(path))


@cache
def drawn() -> tuple[str, ...]:
    """Those that runs of a sample derive: the same in all processes and on all machines, for this code."""
    engine = source_files.digest(["satsym.report.artefacts"])
    draw = sorted(names(), key=lambda name: hashlib.blake2b(f"{engine} {name}".encode()).digest())
    return tuple(name for name in names() if name in draw[: len(draw) // SHARE])


def each(*others: str, left: Iterable[str] = ()) -> list[ParameterSet]:
    """A case for each shipped model, and before them for others; those that were not drawn are studies, as some are."""
    cases = [*others, *names()]
    few = {*others, *drawn()} - set(left)
    return [pytest.param(name, marks=() if name in few else pytest.mark.study) for name in cases]


def shipped(name: str) -> Derivation:
    """The derivation of a shipped problem or model."""
    return derived(stated(name))


@cache
def document(name: str, language: str = "en") -> str:
    """The typeset derivation of a shipped problem or model, rendered once for all tests that read in it."""
    key = identity(stated(name))
    place = _folder() / f"{key}-{language}-{_texts()}.tex"
    text = user_cache.read(place).decode() if key else ""
    if not text:
        text = render(shipped(name), language)
        if key:
            user_cache.write(place, text.encode())
    return text


@cache
def _texts() -> str:
    """A digest of the sentences and translations of which documents are made."""
    folders = {Path(texts.__file__).parent, *(path.parent for path in loader.shipped())}
    found = hashlib.blake2b(digest_size=16)
    for path in sorted(path for folder in folders for path in folder.glob("*.toml")):
        found.update(path.read_bytes())
    return found.hexdigest()


@cache
def stated(name: str) -> Problem | Model:
    """What a shipped derivation file states under a name."""
    return next(one for path in loader.shipped() for one in loader.load(path) if one.name == name)


def _itself(subject: Problem | Model) -> Derivation:
    known = [found for one, found in _THEMSELVES if one is subject]
    if not known:
        known = [derive(subject)]
        _THEMSELVES.append((subject, known[0]))
    return known[0]


@cache
def _folder() -> Path:
    """The folder of this engine; those of others, now useless, go."""
    found = _HOME / stamps.engine()
    if not found.is_dir():
        shutil.rmtree(_HOME, ignore_errors=True)
    return found


def _kept(key: str) -> Derivation | None:
    content = user_cache.read(_folder() / key)
    return pickle.loads(content) if content else None


def _keep(key: str, found: Derivation) -> Derivation:
    stream = io.BytesIO()
    _Exact(stream).dump(found)
    if pickle.loads(stream.getvalue()) == found:
        user_cache.write(_folder() / key, stream.getvalue())
    return found


class _Exact(pickle.Pickler):
    """Writes expressions so that they come back as they stand: sympy's own way multiplies some of them out."""

    def reducer_override(self, value: Any) -> Any:
        if isinstance(value, sp.Add | sp.Mul):
            return _as_it_stood, (type(value), value.args)
        if type(value) is sp.Pow:
            return _power, value.args
        return NotImplemented


def _as_it_stood(kind: type[sp.Add | sp.Mul], terms: tuple[sp.Expr, ...]) -> sp.Expr:
    return kind._from_args(terms)


def _power(base: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    return sp.Pow(base, exponent, evaluate=False)
