"""What became of a saved result that was examined again, for people."""

from __future__ import annotations

from satsym.report.results.examination import Examination
from satsym.report.said import each, message, say
from satsym.report.terminal.certificate import certificate_lines
from satsym.report.terminal.solution import joined
from satsym.report.terminal.table import table, wrapped


def examination_text(found: Examination, colour: bool) -> str:
    """What was stated, what differs from the files, and the certificate that was computed anew."""
    instance, spec = found.solution.instance, found.solution.instance.model.spec
    stated = message(found.stated.value) if found.stated else say("no certificate")
    heading = say("<name>, model <model>", name=instance.name, model=spec.name)
    rows = [(one.key, str(one.stated), str(one.found)) for one in found.differences]
    agreement = say("result.json agrees with the other files")
    if len(rows) == 1:
        agreement = say("one number in result.json does not agree with the other files")
    elif rows:
        agreement = say("<number> numbers in result.json do not agree with the other files", number=len(rows))
    title = instance.title or spec.title
    return joined(
        [
            [f"\x1b[1m{title}\x1b[0m" if colour else title, f"{heading}: {say('stated as <verdict>', verdict=stated)}"],
            wrapped(agreement),
            table([each("key", "stated", "found"), *rows]) if rows else [],
            certificate_lines(found.certificate, spec) if found.certificate else [],
        ]
    )
