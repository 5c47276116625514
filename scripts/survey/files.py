"""Finds glTF files, without copies, and the files that each of them needs."""

import hashlib
import json
import os
import struct
import urllib.parse

SUFFIXES = (".gltf", ".glb")


def document_of(data):
    """The JSON of a glTF file, or None if it cannot be read."""
    try:
        if data[:4] == b"glTF":
            (length,) = struct.unpack_from("<I", data, 12)
            data = data[20 : 20 + length]
        document = json.loads(data.decode("utf-8-sig"))
        return document if isinstance(document, dict) else None
    except (ValueError, struct.error, RecursionError):
        return None


def neighbours_of(path, data):
    """Paths of the files that the glTF file references in buffers and images, present or not."""
    document = document_of(data) or {}
    paths = []
    for key in ("buffers", "images"):
        entries = document.get(key)
        for entry in entries if isinstance(entries, list) else []:
            uri = entry.get("uri") if isinstance(entry, dict) else None
            if isinstance(uri, str) and not uri.startswith("data:") and "\0" not in uri:
                paths.append(os.path.join(os.path.dirname(path), urllib.parse.unquote(uri)))
    return paths


def sha256_of(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


class File:
    """A glTF file: `path`, `name` (relative to the folder given), `source` (what it is counted under)."""

    def __init__(self, path, name, source):
        self.path, self.name, self.source = path, name, source
        with open(path, "rb") as file:
            data = file.read()
        self.sha256 = hashlib.sha256(data).hexdigest()
        needed = neighbours_of(path, data)
        present = {needed_path for needed_path in needed if os.path.isfile(needed_path)}
        self.missing = len(set(needed)) - len(present)
        self.bytes = len(data) + sum(os.path.getsize(needed_path) for needed_path in present)


def walk(folder):
    """Paths of the glTF files in a folder, sorted; a file is its own folder."""
    if os.path.isfile(folder):
        return [folder]
    found = []
    for root, folders, names in os.walk(folder):
        folders.sort()
        found += [os.path.join(root, name) for name in sorted(names) if name.lower().endswith(SUFFIXES)]
    return [path for path in found if os.path.isfile(path)]


def named(argument):
    """(name, path) of NAME=PATH; a path alone has the name of its last folder."""
    name, equals, path = argument.partition("=")
    if equals and not os.path.exists(argument):
        return name, path
    folder = argument if os.path.isdir(argument) else os.path.dirname(argument) or "."
    return os.path.basename(os.path.abspath(folder)), argument


def listed(arguments):
    """Every file of the folders, including copies: each counts under its folder's name."""
    files = []
    for source, folder in map(named, arguments):
        base = folder if os.path.isdir(folder) else os.path.dirname(folder)
        files += [File(path, os.path.relpath(path, base or "."), source) for path in walk(folder)]
    return files


def corpus(folder):
    """The files of a folder of sources: each counts under its source, the first part of its path, where a `+` stands for `/`.

    Of files that are equal byte for byte one stays: the first of those that have the most of their neighbours.
    """
    best = {}
    for path in walk(folder):
        source, _, name = os.path.relpath(path, folder).partition(os.sep)
        file = File(path, name, source.replace("+", "/"))
        if file.sha256 not in best or file.missing < best[file.sha256].missing:
            best[file.sha256] = file
    return list(best.values())


def commits(folder):
    """The version of each source, where its folder has a file .commit."""
    found = {}
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name, ".commit")
        if os.path.isfile(path):
            with open(path, encoding="utf-8") as file:
                found[name.replace("+", "/")] = file.read().strip()
    return found
