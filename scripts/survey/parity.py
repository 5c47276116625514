"""Compares the films of the backends: the hash of each, in each tier."""

import json
import os
import tempfile

from . import runs

BACKENDS = ("cpu", "cuda")
TIERS = ("strict", "precise")


def film_hash(renderer, file, backend, tier):
    """The hash, or the reason why there is none."""
    with tempfile.TemporaryDirectory() as folder:
        json_path = os.path.join(folder, "run.json")
        command = [*renderer.command(file.path, os.path.join(folder, "picture.ppm"), json_path), "--backend", backend, "--tier", tier]
        run = runs.Run(command, renderer.timeout, 0)  # a GPU's driver reserves more addresses than any limit
        if run.status or not os.path.exists(json_path):
            return (run.errors.strip().splitlines() or [f"status {run.status}"])[-1]
        with open(json_path, encoding="utf-8") as stream:
            return json.load(stream)["frames"][0]["film_sha256"]


def compare(renderer, file):
    """{tier: {backend: hash}} and whether they are equal in every tier."""
    tiers = {tier: {backend: film_hash(renderer, file, backend, tier) for backend in BACKENDS} for tier in TIERS}
    return {"source": file.source, "file": file.name, "equal": all(len(set(t.values())) == 1 for t in tiers.values()), "tiers": tiers}
