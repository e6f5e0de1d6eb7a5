"""Audits as objects for JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from satsym.auditing import Judged, Ledger
from satsym.auditing.causes import Finding, findings
from satsym.auditing.ledger.coverage import KINDS, Coverage
from satsym.report.findings.review import counts


def audit_object(judged: Sequence[Judged]) -> dict[str, Any]:
    """Return all rows, the findings, and the number of rows with each verdict."""
    by_document: dict[str, list[Judged]] = {}
    for row in judged:
        by_document.setdefault(row.document, []).append(row)
    found = [finding for rows in by_document.values() for finding in findings(rows)]
    return {
        "rows": [_row_object(row) for row in judged],
        "findings": [_finding_object(finding) for finding in found],
        "counts": counts(judged),
    }


def coverage_object(ledgers: Sequence[Ledger], found: Sequence[Coverage | None]) -> dict[str, Any]:
    """Return the parts of documents, and of their known texts, that have no row."""
    return {
        "coverage": [
            {
                "document": x.document.key,
                "numbers": len(x.document.numbers),
                "rows": len(x.rows),
                "missing": x.uncovered(),
                **({} if text is None else {"text": _text_object(text)}),
            }
            for x, text in zip(ledgers, found, strict=True)
        ]
    }


def _text_object(text: Coverage) -> dict[str, Any]:
    names = ("found", "rows", "excused", "missing")
    return {
        "digest": text.digest,
        "same": text.same,
        "counts": {kind: dict(zip(names, text.counts(kind), strict=True)) for kind in KINDS},
        "missing": {kind: text.missing(kind) for kind in KINDS},
        "unquoted": [{"row": row, "original": piece} for row, piece in text.unquoted],
    }


def _row_object(row: Judged) -> dict[str, Any]:
    return {
        "document": row.document,
        "item": row.item,
        "part": row.part,
        "kind": row.kind,
        "role": row.role,
        "printed": row.printed,
        "derived": row.derived,
        "verdict": row.verdict,
        "cause": row.cause or None,
        "weight": row.weight or None,
        "diagnosis": row.diagnosis,
        "evidence": row.evidence,
    }


def _finding_object(finding: Finding) -> dict[str, Any]:
    return {
        "document": finding.document,
        "cause": finding.cause,
        "weight": finding.weight.value,
        "places": [row.key for row in finding.places],
        "spoils": [row.key for row in finding.spoiled],
        "statement": finding.statement,
        "correction": finding.correction,
    }
