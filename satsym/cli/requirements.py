"""The stated requirements of satsym, and whether the installed versions satisfy them."""

from __future__ import annotations

import re
from dataclasses import dataclass

from satsym.cli.names import checkout
from satsym.status import BadInput

_REQUIREMENT = re.compile(r"([A-Za-z0-9._-]+)([^;]*)(?:;.*extra == ['\"]([^'\"]+)['\"])?")
_CLAUSE = re.compile(r"(==|>=|<)\s*([0-9][0-9.]*)(\.\*)?")


@dataclass(frozen=True)
class Requirement:
    """A distribution that satsym requires, always or for an extra, with its versions."""

    name: str
    versions: str
    extra: str | None = None

    @property
    def installed(self) -> str | None:
        """Return the installed version, if any."""
        from importlib import metadata

        try:
            return metadata.version(self.name)
        except metadata.PackageNotFoundError:
            return None

    def allows(self, version: str) -> bool:
        """Tell whether a version is allowed; only the clauses ``==``, ``>=`` and ``<`` are checked."""
        return all(
            _allows(_numbers(version), operator, _numbers(limit), bool(series))
            for operator, limit, series in _CLAUSE.findall(self.versions)
        )


def requirements() -> list[Requirement]:
    """Return all requirements, as the installed package states them, or the checkout that runs uninstalled."""
    return [Requirement(m[1], m[2].strip(), m[3]) for line in _stated() if (m := _REQUIREMENT.match(line))]


def refuse_other_versions() -> None:
    """Refuse to write generated files with versions other than those of the extra `derive`.

    Raises
    ------
    BadInput
        If another one is here.
    """
    for pinned in requirements():
        if pinned.extra == "derive" and (version := pinned.installed) and not pinned.allows(version):
            raise BadInput(
                f"{pinned.name} {version} is installed, but generated/ must be written with version "
                f"{pinned.name}{pinned.versions}; install that version (pip install "
                f"'{pinned.name}{pinned.versions}'), or derive into another folder with --out DIR"
            )


def _stated() -> list[str]:
    from importlib import metadata

    try:
        return metadata.requires("satsym") or []
    except metadata.PackageNotFoundError:
        return _from_checkout()


def _from_checkout() -> list[str]:
    import tomllib

    home = checkout()
    if home is None:
        return []
    project = tomllib.loads((home / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project.get("optional-dependencies", {})
    return [*project["dependencies"], *(f'{line}; extra == "{extra}"' for extra in extras for line in extras[extra])]


def _numbers(version: str) -> tuple[int, ...]:
    """Return ``1.14.0`` as (1, 14); what follows the numbers, as in ``1.14rc1``, is ignored."""
    numbers = [int(part) for part in re.match(r"[0-9.]*", version)[0].split(".") if part]  # type: ignore[index]
    while numbers and not numbers[-1]:
        numbers.pop()
    return tuple(numbers)


def _allows(version: tuple[int, ...], operator: str, limit: tuple[int, ...], series: bool) -> bool:
    if operator == "==":
        return version[: len(limit)] == limit if series else version == limit
    return version >= limit if operator == ">=" else version < limit
