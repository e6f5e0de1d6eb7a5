"""Damaged results, drawn at random: of many kinds, most of them with a list that still agrees with the damage."""

from __future__ import annotations

import hashlib
import io
import json
import os
import random
import shutil
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ARRAYS, CSV, LIST = "trajectory.npz", "trajectory.csv", "result.json"
Damage = Callable[[random.Random, Path], object]
NUMBERS = (0, -1, 1e308, -1e308, 5e-324, 10**30, 2**63, 0.5, 1e-9)
VALUES: tuple[Any, ...] = (
    None,
    True,
    "",
    "$\\frac{",
    "\u202e\x1b[31m",
    "x" * 10_000,
    [],
    {},
    [[[]]],
    {"a": None},
    *NUMBERS,
)


def signed(folder: Path) -> None:
    """Have the list of a set say what its files are now, as far as they are files."""
    place = folder / LIST
    result = json.loads(place.read_text(encoding="utf-8"))
    for name in result["files"]:
        if (folder / name).is_file():
            content = (folder / name).read_bytes()
            result["files"][name] = {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
    place.write_text(json.dumps(result), encoding="utf-8")


def damaged(rng: random.Random, folder: Path) -> str:
    """Damage a set, and say how."""
    damage = rng.choice(DAMAGES)
    damage(rng, folder)
    return damage.__name__


def bytes_changed(rng: random.Random, folder: Path) -> None:
    path = folder / rng.choice([ARRAYS, ARRAYS, CSV, LIST])
    content = bytearray(path.read_bytes())
    for _ in range(rng.choice([1, 3, 30])):
        content[rng.randrange(len(content))] = rng.randrange(256)
    path.write_bytes(content)
    if path.name != LIST and rng.random() < 0.7:
        signed(folder)


def directory_of_archive_changed(rng: random.Random, folder: Path) -> None:
    content = bytearray((folder / ARRAYS).read_bytes())
    start = content.rindex(b"PK\x01\x02", 0, content.rindex(b"PK\x05\x06") - rng.randrange(400))
    for _ in range(rng.choice([1, 2, 8])):
        content[rng.randrange(start, len(content))] = rng.choice([0, 1, 8, 255, rng.randrange(256)])
    (folder / ARRAYS).write_bytes(content)
    signed(folder)


def cut_or_continued(rng: random.Random, folder: Path) -> None:
    path = folder / rng.choice([ARRAYS, CSV, LIST])
    content = path.read_bytes()
    path.write_bytes(content[: rng.randrange(len(content))] if rng.random() < 0.6 else content + rng.randbytes(99))
    if path.name != LIST and rng.random() < 0.7:
        signed(folder)


def other_file(rng: random.Random, folder: Path) -> None:
    path = folder / rng.choice([ARRAYS, ARRAYS, CSV, LIST])
    content = path.read_bytes()
    path.unlink()
    kind = rng.choice(["none", "folder", "pipe", "zero", "full", "loop", "dangling", "link", "sparse", "empty"])
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind in ("zero", "full"):
        path.symlink_to(f"/dev/{kind}")
    elif kind == "loop":
        path.symlink_to(path)
    elif kind == "dangling":
        path.symlink_to("nowhere")
    elif kind == "link":
        (folder / "elsewhere").write_bytes(content)
        path.symlink_to("elsewhere")
    elif kind in ("sparse", "empty"):
        path.touch()
        os.truncate(path, 2**40 if kind == "sparse" else 0)


def sparse_and_listed(rng: random.Random, folder: Path) -> None:
    result = json.loads((folder / LIST).read_text(encoding="utf-8"))
    size = rng.choice([2**28 + 1, 2**31 + 1, 2**40])
    result["files"][ARRAYS]["bytes"] = size
    os.truncate(folder / ARRAYS, size)
    (folder / LIST).write_text(json.dumps(result), encoding="utf-8")


def result_changed(rng: random.Random, folder: Path) -> None:
    result = json.loads((folder / LIST).read_text(encoding="utf-8"))
    table = result
    while True:
        key = rng.choice(list(table))
        if not (isinstance(table[key], dict) and table[key] and rng.random() < 0.7):
            break
        table = table[key]
    if rng.random() < 0.2:
        del table[key]
    else:
        table[key] = rng.choice(VALUES)
    (folder / LIST).write_text(json.dumps(result), encoding="utf-8")


def result_of_another_kind(rng: random.Random, folder: Path) -> None:
    texts = [
        "",
        "{",
        "[]",
        "null",
        "[" * 200_000,
        '{"a":' * 200_000,
        "\ufeff{}",
        '{"files": 1e999}',
        "\x00",
        "9" * 10_000,
    ]
    (folder / LIST).write_text(rng.choice(texts), encoding="utf-8")


def arrays_changed(rng: random.Random, folder: Path) -> None:
    with np.load(folder / ARRAYS) as file:
        stored = {name: file[name] for name in file.files}
    for _ in range(rng.choice([1, 1, 2])):
        name = rng.choice(list(stored))
        stored[name] = _other(rng, stored[name])
    np.savez(folder / ARRAYS, **stored)
    signed(folder)


def _other(rng: random.Random, old: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    if old.dtype.kind == "f" and old.size and rng.random() < 0.6:
        new = old.copy()
        where = tuple(rng.randrange(length) for length in old.shape)
        value = rng.choice([np.nan, np.inf, -np.inf, 1e308, -1e308, 5e-324, 1e150, 0.0])
        if rng.random() < 0.5:
            new[where] = value
        else:
            new[...] = value
        return new
    kinds: list[Any] = [old.ravel()[:0], old.ravel()[:1], old[None], np.array(1.0)]
    kinds += [np.array(None), np.array([{}, []], object)]
    kinds += [np.zeros((3, 4), kind) for kind in ("i8", "c16", "?", "f4", "g", "M8[s]", "S3", "U3", "f8,i4", ">f8")]
    return np.asarray(rng.choice(kinds))


def header_forged(rng: random.Random, folder: Path) -> None:
    shape = rng.choice(
        ["(10**9, 10**9)", "(1000000000000,)", "(-1,)", "(4, -5)", "(1.5,)", "(True,)", "()", "(" * 99, "0"]
    )
    kind = rng.choice(["<f8", "|O", "<U0", "<U999999999", "|V8", "nonsense", "<f8,<f8"])
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    version = rng.choice([b"\x01\x00", b"\x02\x00", b"\x03\x00", b"\x09\x00"])
    length = struct.pack("<H" if version == b"\x01\x00" else "<I", rng.choice([len(header), 65535]))
    _replaced(rng, folder, b"\x93NUMPY" + version + length + header + bytes(64))


def _replaced(rng: random.Random, folder: Path, content: bytes, compression: int = zipfile.ZIP_STORED) -> None:
    """Give an archive another member in the place of one."""
    with zipfile.ZipFile(folder / ARRAYS) as file:
        members = {name: file.read(name) for name in file.namelist()}
    members[rng.choice(list(members))] = content
    with zipfile.ZipFile(folder / ARRAYS, "w") as file:
        for name, each in members.items():
            file.writestr(name, each, compression if each is content else zipfile.ZIP_STORED)
    signed(folder)


def bomb(rng: random.Random, folder: Path) -> None:
    _replaced(rng, folder, bytes(3 * 10**7), zipfile.ZIP_DEFLATED)


def members_without_end(rng: random.Random, folder: Path) -> None:
    with zipfile.ZipFile(folder / ARRAYS, "a") as file:
        for number in range(rng.choice([1, 20, 70_000])):
            file.writestr(zipfile.ZipInfo(f"{number}.npy"), b"")
    signed(folder)


def encrypted(rng: random.Random, folder: Path) -> None:
    content = bytearray((folder / ARRAYS).read_bytes())
    for mark, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        content[content.index(mark) + offset] |= 1
    (folder / ARRAYS).write_bytes(content)
    signed(folder)


def another_archive(rng: random.Random, folder: Path) -> None:
    stream = io.BytesIO()
    if rng.random() < 0.5:
        np.save(stream, np.zeros(3))
    else:
        with zipfile.ZipFile(stream, "w") as file:
            file.writestr(rng.choice(["../x.npy", "x", "times.npy/", "times.npy"]), rng.randbytes(80))
    (folder / ARRAYS).write_bytes(stream.getvalue())
    signed(folder)


def left_behind(rng: random.Random, folder: Path) -> None:
    """As a kill might, and as no kill can."""
    following = folder / ".satsym-next"
    kind = rng.choice(["file", "empty", "half", "whole", "staging"])
    if kind == "file":
        following.touch()
        return
    place = folder / ".satsym-new-1" if kind == "staging" else following
    place.mkdir()
    if kind in ("half", "whole"):
        shutil.copy(folder / LIST, place)
        shutil.copy(folder / ARRAYS, place)
    if kind == "half":
        os.truncate(place / ARRAYS, 100)


DAMAGES: tuple[Damage, ...] = (
    *(bytes_changed, directory_of_archive_changed, cut_or_continued, other_file, sparse_and_listed, result_changed),
    *(result_of_another_kind, arrays_changed, arrays_changed, header_forged, bomb, members_without_end, encrypted),
    *(another_archive, left_behind),
)
