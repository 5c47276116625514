#!/usr/bin/env python3
"""Renders glTF files from other sources and reports the outcome of each: rendered, refused and why, or a failure.

  scripts/survey_gltf.py [NAME=]FILE|FOLDER... [--corpus FOLDER] --json survey.json
  scripts/survey_gltf.py ... --summary docs/results/gltf-files/survey.json --page docs/results/gltf-files.md

The page lists FILEs and FOLDERs one by one. --corpus names a folder of folders, one per source: their files are only counted,
without duplicates. The script runs tandem-render on every file, --jobs at a time. An interrupted run with --json resumes.

Exit status: 0 every file was rendered, or refused with a message; 1 a crash, a hang or an unexpected status, or with --parity
films that differ; 2 wrong usage; 3 the machine lacks something.
"""

import argparse
import json
import os
import platform
import subprocess
import sys

from survey import files, journal, outcome, page, parity, runs, sheets, summary

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def stop(message, status=2):
    print(f"survey_gltf: {message}", file=sys.stderr)
    sys.exit(status)


def options_of(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", metavar="[NAME=]FILE|FOLDER", help="files that the page lists one by one, under NAME or the folder's name")
    parser.add_argument("--corpus", metavar="FOLDER", help="a folder of sources whose files are only counted")
    parser.add_argument("--render", default=os.path.join(ROOT, "build", "release", "bin", "tandem-render"), metavar="PROGRAM")
    parser.add_argument("--size", default="16x12")
    parser.add_argument("--spp", type=int, default=1)
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--tier", default="strict")
    parser.add_argument("--jobs", type=int, default=1, help="files at a time (1)")
    parser.add_argument("--timeout", type=float, default=120, help="seconds until a run counts as a hang (120)")
    parser.add_argument("--memory", type=int, default=8192, metavar="MIB", help="address space of a run in MiB (8192); 0: no limit")
    parser.add_argument("--json", metavar="FILE", help="write the record of every file")
    parser.add_argument("--summary", metavar="FILE", help="write the figures that the page quotes")
    parser.add_argument("--page", metavar="FILE", help="write the Markdown page; needs --summary")
    parser.add_argument("--from", dest="read", metavar="JSON", help="read the records of an earlier --json instead of rendering")
    parser.add_argument("--sheet", metavar="FOLDER", help="write contact sheets of the images; needs Pillow, and a larger --size")
    parser.add_argument("--parity", action="store_true", help="compare the films of cpu and cuda, in strict and precise")
    parser.add_argument("--commit", help="the commit that the program was built from; default: HEAD of this tree")
    parser.add_argument("--remark", default="", help="a sentence about the run for the page")
    parser.add_argument("--quiet", action="store_true", help="no progress")
    options = parser.parse_args(arguments)
    if not (options.folders or options.corpus or options.read):
        stop("nothing to do; name files or folders, a --corpus, or --from an earlier survey")
    if options.page and not options.summary:
        stop("--page needs --summary, which the page refers to")
    if options.sheet and not sheets.pillow():
        stop("--sheet needs the Python package Pillow; install it with 'pip install pillow'", 3)
    for path in [*(files.named(folder)[1] for folder in options.folders), *([options.corpus] if options.corpus else [])]:
        if not os.path.exists(path):
            stop(f"there is no {path}")
    if not options.read and not os.access(options.render, os.X_OK):
        stop(f"there is no program {options.render}; build it, or name it with --render", 3)
    return options


def output_of(command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def about(options):
    """The description of the run for the page, without paths of this machine."""
    paths = [os.path.basename(os.path.abspath(files.named(folder)[1])) for folder in options.folders]
    command = ["scripts/survey_gltf.py", *paths, *(["--corpus", os.path.basename(os.path.abspath(options.corpus))] if options.corpus else [])]
    return {
        "command": " ".join([*command, "--size", options.size, "--spp", str(options.spp), "--jobs", str(options.jobs)]),
        "version": output_of([options.render, "--version"]),
        "commit": options.commit or output_of(["git", "-C", ROOT, "rev-parse", "--short=10", "HEAD"]),
        "remark": options.remark,
        "size": options.size,
        "spp": options.spp,
        "backend": options.backend,
        "tier": options.tier,
        "machine": f"{os.cpu_count()} cores, {platform.machine()}",
    }


def progress_line(what, quiet):
    def say(done, of):
        if not quiet and (sys.stderr.isatty() or done % 500 == 0 or done == of):
            print(f"survey_gltf: {what} {done} of {of}", file=sys.stderr, end="\r" if sys.stderr.isatty() and done < of else "\n")

    return say


def write_json(path, data):
    with open(path, "w", encoding="utf-8") as stream:
        json.dump(data, stream, ensure_ascii=False, indent=0, separators=(",", ":"))
        stream.write("\n")


def drawn_survey(options, renderer, listed, corpus):
    run = {"program": files.sha256_of(options.render), "command": renderer.command("", "", "")[1:], "memory": options.memory}
    kept = journal.Journal(options.json and options.json + ".part", run)

    def record_of(file):
        record = kept.kept(file)
        if not record:
            record = runs.survey_file(renderer, file)
            kept.add(record)
        return record

    records = runs.each([*listed, *corpus], options.jobs, record_of, progress_line("rendered", options.quiet))
    kept.close()
    commits = files.commits(options.corpus) if options.corpus else {}
    return {"run": about(options), "commits": commits, "listed": records[: len(listed)], "corpus": records[len(listed) :]}


def report_of(survey):
    """Prints the totals; returns whether every file was rendered, or refused with a message."""
    records = survey["listed"] + survey["corpus"]
    for name, count in summary.counts(records).items():
        print(f"{count:6} {name}")
    for record in records:
        if record["outcome"] in outcome.BAD:
            print(f"{record['outcome']}: {summary.place(record)}: status {record['status']}")
        elif summary.is_costly(record):
            print(f"costly: {summary.place(record)}: {record['bytes']} bytes, {record['cpu_seconds']} s, {record['peak_mib']} MiB")
    return not any(record["outcome"] in outcome.BAD for record in records)


def main():
    options = options_of(sys.argv[1:])
    extra = ["--backend", options.backend, "--tier", options.tier]
    renderer = runs.Renderer(options.render, options.size, options.spp, options.timeout, options.memory, extra)
    listed = files.listed(options.folders)
    corpus = files.corpus(options.corpus) if options.corpus else []
    if options.sheet:
        shown = sheets.write(options.sheet, renderer, [*listed, *corpus], options.jobs)
        print(f"{shown} images in {options.sheet}")
        return 0
    if options.parity:
        plain = runs.Renderer(options.render, options.size, options.spp, options.timeout, 0)
        found = runs.each([*listed, *corpus], options.jobs, lambda file: parity.compare(plain, file), progress_line("compared", options.quiet))
        if options.json:
            write_json(options.json, found)
        for entry in found:
            if not entry["equal"]:
                print(f"differs: {summary.place(entry)}: {entry['tiers']}")
        print(f"{sum(entry['equal'] for entry in found)} of {len(found)} equal")
        return 0 if all(entry["equal"] for entry in found) else 1
    if options.read:
        with open(options.read, encoding="utf-8") as stream:
            survey = json.load(stream)
    else:
        survey = drawn_survey(options, renderer, listed, corpus)
    if options.json:
        write_json(options.json, survey)
    short = summary.summary_of(survey)
    if options.summary:
        write_json(options.summary, short)
    if options.page:
        with open(options.page, "w", encoding="utf-8") as stream:
            stream.write(page.page_of(short, os.path.relpath(options.summary, os.path.dirname(options.page) or ".")))
    return 0 if report_of(survey) else 1


if __name__ == "__main__":
    sys.exit(main())
