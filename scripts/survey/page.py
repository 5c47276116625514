"""Writes the Markdown page of a survey. Every figure is from the summary, which is beside the page as JSON."""

import textwrap

from . import outcome, summary

LONGEST = 220  # letters of a sentence


def cell(text):
    """Escapes text from a file for a table: nothing in it is Markdown or HTML."""
    text = "".join(letter if letter.isprintable() else " " for letter in text)
    text = text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
    for letter, safe in (("&", "&amp;"), ("<", "&lt;"), ("|", "\\|"), ("[", "\\["), ("*", "\\*"), ("_", "\\_"), ("`", "\\`")):
        text = text.replace(letter, safe)
    return text


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(value) for value in row) + " |" for row in rows])


def share(part, whole):
    return f"{part:,} ({100 * part / whole:.0f} %)" if whole else "0"


def drawn(outcomes):
    return outcomes.get(outcome.DRAWN, 0) + outcomes.get(outcome.NOTES, 0)


def features_of(record):
    """'approximated: a, b; ignored: c' """
    parts = []
    for treatment in ("approximated", "ignored"):
        named = list(dict.fromkeys(feature for t, feature, _ in record["notes"] if t == treatment))
        if named:
            parts.append(f"{treatment}: " + ", ".join(named))
    return "; ".join(parts)


def listed(records):
    """One table per folder, with the outcome of every file."""
    parts = []
    for source in dict.fromkeys(record["source"] for record in records):
        group = [record for record in records if record["source"] == source]
        rows = []
        for record in group:
            why = features_of(record) if "film_sha256" in record else record["sentence"]
            what = "rendered" if "film_sha256" in record else record["outcome"]
            blank = ", a single colour" if record.get("one_colour") else ""
            rows.append([cell(record["file"]), what + blank, cell(why), f"{record['cpu_seconds']:.2f}", f"{record['peak_mib']:.0f}"])
        parts.append(f"## {source}\n\n" + table(["file", "outcome", "reason, or what is approximated or ignored", "CPU s", "peak MiB"], rows))
    return "\n\n".join(parts)


def sources(totals):
    rows = []
    for group in totals["sources"]:
        found = group["outcomes"]
        other = ", ".join(f"{n} {name}" for name, n in found.items() if name not in (outcome.DRAWN, outcome.NOTES, outcome.REFUSED))
        rows.append(
            [cell(group["source"]), group["commit"][:10], f"{group['files']:,}", share(drawn(found), group["files"]), found.get(outcome.REFUSED, 0), other]
        )
    return table(["source", "commit", "files", "rendered", "refused", "other"], rows)


def refusals(totals):
    return table(["reason", "files", "example"], [[cell(g["why"]), g["files"], cell(g["example"])] for g in totals["refusals"]])


def features(totals, most):
    rows = [[group["treatment"], cell(group["feature"]), group["files"]] for group in totals["features"][:most]]
    return table(["treatment", "feature", "files"], rows)


def cost(totals):
    figures = totals["cost"]
    lines = [
        table(
            ["of all files", "median", "99 %", "largest"],
            [[name, *(f"{figures[key][p]:,.{digits}f}" for p in ("0.5", "0.99", "1"))]
             for name, key, digits in (("CPU seconds", "cpu_seconds", 2), ("peak memory, MiB", "peak_mib", 0))],
        )
    ]
    costly = figures["costly_small_files"]
    limits = f"{summary.MOST_MIB} MiB or {summary.MOST_CPU_SECONDS} s of CPU"
    lines.append(f"Files under {summary.SMALL_BYTES // 10**6} MB, including the files that they reference, that took more than {limits}: {len(costly)} of {figures['small_files']:,}.")
    if costly:
        rows = [[cell(r["source"] + "/" + r["file"]), f"{r['bytes']:,}", f"{r['cpu_seconds']:.1f}", f"{r['peak_mib']:,.0f}"] for r in costly]
        lines.append(table(["file", "bytes", "CPU s", "peak MiB"], rows))
    return "\n\n".join(lines)


def overview(name, totals):
    found = totals["outcomes"]
    bad = sum(found.get(kind, 0) for kind in outcome.BAD)
    return [name, f"{totals['files']:,}", share(drawn(found), totals["files"]), f"{found.get(outcome.DRAWN, 0):,}",
            f"{found.get(outcome.REFUSED, 0):,}", found.get(outcome.ENVIRONMENT, 0), bad]


def paragraph(text):
    return textwrap.fill(" ".join(text.split()), 128, break_long_words=False, break_on_hyphens=False)


def page_of(data, json_name, most_features=40):
    """The whole page; json_name is the path of the summary, relative to the page."""
    run, corpus, files = data["run"], data["corpus"], data["listed_totals"]
    head = ["", "files", "rendered", "without a note", "refused", "environment", "crash, hang, odd status"]
    rows = [overview("listed below", files)] + ([overview("the corpus", corpus)] if corpus["files"] else [])
    parts = [
        "# glTF files from other sources",
        paragraph(
            f"""Each file is rendered once, unchanged, with `tandem-render FILE -o PICTURE --size {run['size']} --spp {run['spp']}`.
            `scripts/survey_gltf.py` ran the program, wrote [the figures]({json_name}) and generated this page from them. Version {run['version']}, commit {run['commit']}, backend {run['backend']}; {run['machine']}. {run['remark']} The command:"""
        ),
        "```\n" + run["command"] + "\n```",
        table(head, rows),
        paragraph(
            """**Rendered** means exit status 0 and an image; notes say what is approximated or ignored. **Refused** means status 2 with a
            message. **Environment** means status 3: the machine lacks something, such as memory. A crash is a signal; a hang is a run
            that exceeded the time limit and was ended."""
        ),
        listed(data["listed"]),
    ]
    if corpus["files"]:
        parts += [
            "## The corpus",
            paragraph(
                """Files of public repositories, as far as their snapshots were complete: tests of loaders, samples, parts of engines and
                viewers. Identical files count once. Many are invalid on purpose, to test what a loader refuses. The commit is
                that of the snapshot."""
            ),
            sources(corpus),
            "### What is refused",
            "Equal messages share a row; `#` stands for a number, `…` for a name.",
            refusals(corpus),
            "### What is approximated or ignored",
            f"Rendered files of the corpus with a note, by feature{', the ' + str(most_features) + ' most frequent' if len(corpus['features']) > most_features else ''}.",
            features(corpus, most_features),
            "### What a file costs",
            cost(corpus),
        ]
    return "\n\n".join(parts) + "\n"
