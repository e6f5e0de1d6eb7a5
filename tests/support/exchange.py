"""Readers of the formats that motions are exported to, written from what is published of these, not from ours."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial


@dataclass(frozen=True)
class Segment:
    """Points in km and km/s at seconds from an instant, and what stands above them."""

    keys: dict[str, str]
    comments: list[str]
    start: datetime
    times: np.ndarray
    places: np.ndarray
    paces: np.ndarray

    def at(self, time: float) -> np.ndarray:
        """The position at a time, by Hermite's interpolation through four points with their velocities."""
        k = int(np.clip(np.searchsorted(self.times, time) - 2, 0, max(0, len(self.times) - 4)))
        near = slice(k, k + 4)
        return hermite(self.times[near], self.places[:, near], self.paces[:, near], time)


def hermite(times: np.ndarray, places: np.ndarray, paces: np.ndarray, time: float) -> np.ndarray:
    """Lagrange's squares: at each point one polynomial has the value one and another the slope one, all others none."""
    total, unit = np.zeros(len(places)), times[-1] - times[0]
    s, at = (times - times[0]) / unit, (time - times[0]) / unit
    for k, own in enumerate(s):
        others = np.delete(s, k)
        basis = Polynomial.fromroots(others)
        basis = basis / basis(own)
        slope = basis.deriv()(own)
        square = basis(at) ** 2
        total += (1.0 - 2.0 * slope * (at - own)) * square * places[:, k]
        total += (at - own) * square * paces[:, k] * unit
    return total


def oem(text: str) -> list[Segment]:
    """The segments of an orbit ephemeris message in keyword-value notation (CCSDS 502.0-B-2, section 5)."""
    lines = [line for line in map(str.strip, text.splitlines()) if line]
    assert re.fullmatch(r"CCSDS_OEM_VERS\s*=\s*2\.0", lines[0])
    head = lines[: lines.index("META_START")]
    assert {"CREATION_DATE", "ORIGINATOR"} <= {line.partition("=")[0].strip() for line in head}
    found = []
    for part in "\n".join(lines).split("META_START\n")[1:]:
        meta, rest = part.split("META_STOP\n")
        keys = {key.strip(): value.strip() for key, _, value in (line.partition("=") for line in meta.splitlines())}
        wanted = "OBJECT_NAME OBJECT_ID CENTER_NAME REF_FRAME TIME_SYSTEM START_TIME STOP_TIME".split()
        assert [key for key in keys if key in wanted] == wanted
        comments = [line.removeprefix("COMMENT ") for line in rest.splitlines() if line.startswith("COMMENT")]
        rows = [line.split() for line in rest.splitlines() if not line.startswith("COMMENT")]
        start = moment(rows[0][0])
        assert keys["START_TIME"] == rows[0][0]
        assert keys["STOP_TIME"] == rows[-1][0]
        times = np.array([(moment(row[0]) - start).total_seconds() for row in rows])
        assert (np.diff(times) > 0).all()
        values = np.array([[float(value) for value in row[1:7]] for row in rows]).T
        found.append(Segment(keys, comments, start, times, values[:3], values[3:]))
    return found


def moment(text: str) -> datetime:
    """An instant in UTC as CCSDS writes it, to the microsecond."""
    whole, _, fraction = text.rstrip("Z").partition(".")
    return datetime.fromisoformat(whole).replace(microsecond=round(float(f"0.{fraction or 0}") * 1e6), tzinfo=UTC)


MONTHS = {name: k for k, name in enumerate("jan feb mar apr may jun jul aug sep oct nov dec".split(), 1)}


def stk(text: str) -> tuple[Segment, list[float]]:
    """An ephemeris as the help of STK describes it: keywords in any case, then a table; and times of boundaries."""
    lines = [line.strip() for line in text.splitlines()]
    assert re.fullmatch(r"stk\.v\.\d+\.\d+", lines[0])
    comments = [line[1:].strip() for line in lines if line.startswith("#")]
    lines = [line for line in lines[1:] if line and not line.startswith("#")]
    assert lines[0].lower() == "begin ephemeris"
    assert lines[-1].lower() == "end ephemeris"
    keys, boundaries, rows, block = {}, [], [], ""
    for line in lines[1:-1]:
        key, _, value = line.partition(" ")
        if line.lower() in ("begin segmentboundarytimes", "ephemeristimeposvel"):
            block = line.lower().split()[-1]
        elif line.lower() == "end segmentboundarytimes":
            block = ""
        elif block == "segmentboundarytimes":
            boundaries.append(float(line))
        elif block:
            rows.append([float(number) for number in line.split()])
        else:
            keys[key.lower()] = value.strip()
    assert int(keys["numberofephemerispoints"]) == len(rows)
    day, month, year, clock = keys["scenarioepoch"].split()
    date = f"{int(year):04d}-{MONTHS[month.lower()]:02d}-{int(day):02d}T{clock}"
    table = np.array(rows).T
    scale = {"meters": 1e-3, "kilometers": 1.0}[keys["distanceunit"].lower()]
    return Segment(keys, comments, moment(date), table[0], scale * table[1:4], scale * table[4:7]), boundaries


def czml(text: str) -> dict[str, Any]:
    """Packets by id; the position of each as seconds from its epoch and kilometres."""
    packets = json.loads(text)
    assert packets[0]["id"] == "document"
    assert packets[0]["version"] == "1.0"
    found = {packet["id"]: packet for packet in packets}
    for packet in packets[1:]:
        rows = np.array(packet["position"]["cartesian"]).reshape(-1, 4).T
        packet["times"], packet["places"] = rows[0], rows[1:] / 1e3
        packet["start"], packet["end"] = map(moment, packet["availability"].split("/"))
    return found
