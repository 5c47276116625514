"""Stores the records of a long run as they come, so that a stopped run can be resumed."""

import json
import os
import threading


class Journal:
    """One line per record, after a line that identifies the run. Lines of another run are ignored."""

    def __init__(self, path, run):
        self.path, self.lock, self.records = path, threading.Lock(), {}
        if path and os.path.exists(path):
            with open(path, encoding="utf-8") as stream:
                lines = stream.read().split("\n")[:-1]  # text after the last line end is incomplete
            if lines and json.loads(lines[0]) == run:
                self.records = {(r["source"], r["file"], r["sha256"]): r for r in map(json.loads, lines[1:])}
        if path:
            with open(path, "w", encoding="utf-8") as stream:
                for entry in [run, *self.records.values()]:
                    stream.write(json.dumps(entry) + "\n")

    def kept(self, file):
        return self.records.get((file.source, file.name, file.sha256))

    def add(self, record):
        if not self.path:
            return
        with self.lock, open(self.path, "a", encoding="utf-8") as stream:
            stream.write(json.dumps(record) + "\n")

    def close(self):
        if self.path:
            os.remove(self.path)
