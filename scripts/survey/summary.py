"""Computes the figures of the page from the records of a survey."""

import collections

from . import outcome

SMALL_BYTES = 2_000_000
MOST_MIB = 512
MOST_CPU_SECONDS = 5


def is_costly(record):
    """Whether a small file takes much memory or time."""
    much = record["peak_mib"] > MOST_MIB or record["cpu_seconds"] > MOST_CPU_SECONDS
    return much and record["bytes"] < SMALL_BYTES


def counts(records):
    found = collections.Counter(record["outcome"] for record in records)
    return {name: found[name] for name in outcome.OUTCOMES if found[name]}


def refusals(records):
    """Groups of equal reasons, the largest first, each with an example."""
    groups = collections.defaultdict(list)
    for record in records:
        if record["outcome"] in (outcome.REFUSED, outcome.ENVIRONMENT):
            groups[outcome.group_of(record["sentence"])].append(record)
    ordered = sorted(groups.items(), key=lambda item: (-len(item[1]), item[0]))
    return [{"why": why, "files": len(group), "example": place(group[0])} for why, group in ordered]


def features(records):
    """The number of rendered files in which each feature is approximated or ignored."""
    found = collections.Counter()
    for record in records:
        if record["outcome"] == outcome.NOTES:
            found.update({(treatment, feature) for treatment, feature, _ in record["notes"]})
    return [{"treatment": t, "feature": f, "files": n} for (t, f), n in sorted(found.items(), key=lambda item: (-item[1], item[0]))]


def place(record):
    return record["source"] + "/" + record["file"]


def percentile(values, part):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(part * len(ordered)))] if ordered else 0


def cost(records):
    costly = [record for record in records if is_costly(record)]
    return {
        "cpu_seconds": {str(p): percentile([r["cpu_seconds"] for r in records], p) for p in (0.5, 0.99, 1)},
        "peak_mib": {str(p): percentile([r["peak_mib"] for r in records], p) for p in (0.5, 0.99, 1)},
        "small_files": sum(record["bytes"] < SMALL_BYTES for record in records),
        "costly_small_files": [{key: record[key] for key in ("source", "file", "bytes", "cpu_seconds", "peak_mib")} for record in costly],
    }


def by_source(records, commits):
    groups = collections.defaultdict(list)
    for record in records:
        groups[record["source"]].append(record)
    return [
        {"source": source, "commit": commits.get(source, ""), "files": len(group), "outcomes": counts(group)}
        for source, group in sorted(groups.items(), key=lambda item: item[0].lower())
    ]


def totals(records, commits):
    drawn = [record for record in records if "one_colour" in record]
    return {
        "files": len(records),
        "outcomes": counts(records),
        "sources": by_source(records, commits),
        "refusals": refusals(records),
        "features": features(records),
        "one_colour": sum(record["one_colour"] for record in drawn),
        "bad": [place(record) for record in records if record["outcome"] in outcome.BAD],
        "cost": cost(records),
    }


KEPT = ("source", "file", "bytes", "outcome", "sentence", "notes", "cpu_seconds", "peak_mib", "film_sha256", "one_colour")


def summary_of(survey):
    """The data of the page: the listed files one by one, the corpus in totals."""
    listed = [{key: record[key] for key in KEPT if key in record} for record in survey["listed"]]
    return {
        "run": survey["run"],
        "listed": listed,
        "listed_totals": totals(survey["listed"], {}),
        "corpus": totals(survey["corpus"], survey["commits"]),
    }
