"""Runs tandem-render on a file and measures time and memory."""

import concurrent.futures
import json
import os
import resource
import signal
import subprocess
import tempfile
import threading
import time

from . import outcome

LARGEST_ERRORS = 1 << 20  # bytes of standard error that are kept


class Renderer:
    """The program and its common options."""

    def __init__(self, program, size, spp, timeout, memory_mib, extra=()):
        self.program, self.size, self.spp, self.timeout, self.memory_mib = program, size, spp, timeout, memory_mib
        self.extra = list(extra)

    def command(self, scene, picture, json_path):
        return [self.program, scene, "-o", picture, "--size", self.size, "--spp", str(self.spp), "--json", json_path, *self.extra]


class Run:
    """status, timed_out, errors, cpu_seconds, wall_seconds, peak_mib of a command."""

    def __init__(self, command, timeout, memory_mib):
        with tempfile.TemporaryFile() as errors:
            began = time.monotonic()
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors)
            if memory_mib:
                try:
                    resource.prlimit(process.pid, resource.RLIMIT_AS, (memory_mib << 20, memory_mib << 20))
                except ProcessLookupError:
                    pass  # it has ended
            self.timed_out = False
            done = threading.Event()

            def stop():
                if not done.is_set():
                    self.timed_out = True
                    os.kill(process.pid, signal.SIGKILL)

            timer = threading.Timer(timeout, stop)
            timer.start()
            os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # the pid stays reserved until the timer ends
            done.set()
            timer.cancel()
            timer.join()
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = self.status = os.waitstatus_to_exitcode(status)
            self.wall_seconds = time.monotonic() - began
            self.cpu_seconds = usage.ru_utime + usage.ru_stime
            self.peak_mib = usage.ru_maxrss / 1024
            errors.seek(0)
            self.errors = errors.read(LARGEST_ERRORS).decode("utf-8", "replace")


def levels_of(path):
    """The 8-bit levels of a binary PPM, or None if it is absent or torn."""
    if not os.path.exists(path):
        return None
    with open(path, "rb") as file:
        data = file.read()
    fields, at = [], 0
    while len(fields) < 4:  # magic number, width, height, largest level; comments in between
        end = data.find(b"\n", at)
        if end < 0:
            return None
        line, at = data[at:end], end + 1
        fields += [] if line.startswith(b"#") else line.split()
    levels = data[at:]
    return levels if fields[0] == b"P6" and len(levels) == int(fields[1]) * int(fields[2]) * 3 else None


def survey_file(renderer, file):
    """The record of one file, as in the JSON."""
    with tempfile.TemporaryDirectory() as folder:
        picture, json_path = os.path.join(folder, "picture.ppm"), os.path.join(folder, "run.json")
        run = Run(renderer.command(file.path, picture, json_path), renderer.timeout, renderer.memory_mib)
        levels = levels_of(picture)
        notes, sentence = outcome.parts_of(run.errors)
        record = {
            "source": file.source,
            "file": file.name,
            "sha256": file.sha256,
            "bytes": file.bytes,
            "missing_neighbours": file.missing,
            "outcome": outcome.outcome_of(run.status, run.timed_out, sentence, notes, bool(levels)),
            "status": run.status,
            "sentence": outcome.anonymous(sentence, file.path),
            "notes": notes,
            "cpu_seconds": round(run.cpu_seconds, 3),
            "wall_seconds": round(run.wall_seconds, 3),
            "peak_mib": round(run.peak_mib, 1),
        }
        if levels:
            record["mean_level"] = round(sum(levels) / len(levels), 1)
            record["one_colour"] = all(levels[i : i + 3] == levels[:3] for i in range(0, len(levels), 3))
        if levels and os.path.exists(json_path):
            with open(json_path, encoding="utf-8") as stream:
                record["film_sha256"] = json.load(stream)["frames"][0]["film_sha256"]
    return record


def each(files, jobs, task, progress=None):
    """task(file) of every file, in order, `jobs` at a time; progress(done, of) after each."""
    results = [None] * len(files)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        futures = {pool.submit(task, file): i for i, file in enumerate(files)}
        for done, future in enumerate(concurrent.futures.as_completed(futures), 1):
            results[futures[future]] = future.result()
            if progress:
                progress(done, len(files))
    return results
