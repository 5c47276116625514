"""Tests of scripts/survey_gltf.py: what a run is called, on made-up programs and on tandem-render itself.

usage: survey_test.py ROOT TANDEM_RENDER
"""

import base64
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

root, render, options = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3:]  # options of survey_gltf.py
sys.path.insert(0, str(root / "scripts"))
from survey import files, journal, outcome, page, runs, summary  # noqa: E402

# What a scene's name makes the fake program do; $3 is the picture, $9 the JSON.
FAKE = """#!/bin/sh
case "$1" in
    *crash*) kill -SEGV $$ ;;
    *hang*) sleep 60 ;;
    *odd*) echo "tandem-render: some exception" >&2; exit 1 ;;
    *silent*) exit 2 ;;
    *nothing*) exit 0 ;;
    *memory*) echo "tandem-render: not enough memory on this machine" >&2; exit 3 ;;
    *noted*) echo "tandem-render: ignored: skin at skins[0] (2 uses): why: because" >&2 ;;
esac
printf 'P6\\n# a comment\\n2 1\\n255\\nabcabc' > "$3"
echo '{"frames": [{"film_sha256": "feed"}]}' > "$9"
"""


def triangle():
    """A glTF file of one triangle before a camera."""
    data = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0.3, 0.3, 2]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
    }
    return json.dumps(document)


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path


class Sentences(unittest.TestCase):
    def test_a_note_has_a_treatment_a_feature_and_uses(self):
        self.assertEqual(outcome.note_of("ignored: light range at extensions.lights[0].range (12 uses): why"), ["ignored", "light range", 12])
        self.assertEqual(outcome.note_of("approximated: no camera, framed"), ["approximated", "no camera", 1])
        self.assertIsNone(outcome.note_of("the scene is ignored: no"))

    def test_notes_are_told_from_the_message(self):
        notes, sentence = outcome.parts_of("tandem-render: ignored: skin at skins[0]: no\ntandem-render: a.gltf: bad\nsecond line\n")
        self.assertEqual(notes, [["ignored", "skin", 1]])
        self.assertEqual(sentence, "a.gltf: bad\nsecond line")

    def test_equal_reasons_are_one_group(self):
        first = outcome.group_of("FILE: accessors[2]: element 17 is -1.5e+30, but 'Fox' has 3 bytes")
        second = outcome.group_of("FILE: accessors[31]: element 4 is 2, but 'Big fox' has 19 bytes")
        self.assertEqual(first, second)
        draco = outcome.group_of("requires 'KHR_draco_mesh_compression'")
        self.assertNotEqual(draco, outcome.group_of("requires 'KHR_texture_basisu'"))

    def test_an_apostrophe_is_no_quote(self):
        text = "FILE: scene: is 4, but the file's array 'scenes' has 2 elements"
        self.assertEqual(outcome.group_of(text), "FILE: scene: is #, but the file's array '…' has # elements")

    def test_no_path_of_the_machine_stays(self):
        text = outcome.anonymous("/home/me/a.gltf: /home/me/b.bin is cut off", "/home/me/a.gltf")
        self.assertEqual(text, "FILE: b.bin is cut off")


class Runs(Folder):
    def outcomes(self, names, timeout=20.0):
        program = self.write("fake", FAKE)
        program.chmod(0o755)
        renderer = runs.Renderer(str(program), "2x1", 1, timeout, 1024)
        scenes = [files.File(str(self.write(name + ".gltf", "{}")), name, "tests") for name in names]
        return runs.each(scenes, 2, lambda file: runs.survey_file(renderer, file))

    def test_every_end_of_a_run_has_a_name(self):
        expected = {
            "fine": outcome.DRAWN,
            "noted": outcome.NOTES,
            "crash": outcome.CRASH,
            "odd": outcome.ODD,
            "silent": outcome.ODD,
            "nothing": outcome.ODD,
            "memory": outcome.ENVIRONMENT,
        }
        records = self.outcomes(expected)
        self.assertEqual({record["file"]: record["outcome"] for record in records}, expected)
        self.assertEqual(records[0]["film_sha256"], "feed")
        self.assertTrue(records[0]["one_colour"])
        self.assertEqual(records[1]["notes"], [["ignored", "skin", 2]])

    def test_a_hang_is_ended(self):
        (record,) = self.outcomes(["hang"], timeout=0.5)
        self.assertEqual(record["outcome"], outcome.HANG)

    def test_tandem_render_draws_and_refuses(self):
        renderer = runs.Renderer(render, "16x12", 1, 100, 0)
        fine = files.File(str(self.write("fine.gltf", triangle())), "fine.gltf", "tests")
        wrong = files.File(str(self.write("wrong.gltf", triangle()[:-1])), "wrong.gltf", "tests")
        drawn, refused = (runs.survey_file(renderer, file) for file in (fine, wrong))
        self.assertEqual((drawn["status"], drawn["outcome"]), (0, outcome.NOTES), drawn)
        self.assertFalse(drawn["one_colour"])
        self.assertEqual(len(drawn["film_sha256"]), 64)
        self.assertGreater(drawn["peak_mib"], 1)
        self.assertEqual((refused["status"], refused["outcome"]), (2, outcome.REFUSED), refused)
        self.assertIn("FILE: is not well-formed JSON", refused["sentence"])


class Journals(Folder):
    def test_a_stopped_run_goes_on(self):
        path, run = str(self.folder / "s.json.part"), {"program": "1"}
        file = files.File(str(self.write("a.gltf", "{}")), "a.gltf", "tests")
        record = {"source": "tests", "file": "a.gltf", "sha256": file.sha256, "status": 0}
        journal.Journal(path, run).add(record)
        with open(path, "a", encoding="utf-8") as stream:
            stream.write('{"source": "tests", "fi')
        self.assertEqual(journal.Journal(path, run).kept(file), record)
        self.assertIsNone(journal.Journal(path, {"program": "2"}).kept(file))


class Files(Folder):
    def test_of_copies_the_one_with_its_neighbours_stays(self):
        text = '{"buffers": [{"uri": "a%20b.bin"}]}'
        self.write("one+x/scene.gltf", text)
        self.write("two+y/deep/scene.gltf", text)
        self.write("two+y/deep/a b.bin", "12345")
        self.write("two+y/deep/other.txt", "")
        (found,) = files.corpus(str(self.folder))
        self.assertEqual((found.source, found.name), ("two/y", "deep/scene.gltf"))
        self.assertEqual((found.missing, found.bytes), (0, len(text) + 5))

    def test_a_folder_may_have_a_name(self):
        self.write("models/scene.glb", "no glTF")
        (found,) = files.listed([f"samples={self.folder}/models"])
        self.assertEqual((found.source, found.name), ("samples", "scene.glb"))


class Page(Folder):
    def test_the_page_quotes_the_survey(self):
        self.write("a+b/fine.gltf", triangle())
        self.write("a+b/wrong|<b>.gltf", "no JSON")
        self.write("a+b/.commit", "0123456789abcdef")
        survey_json, short, text = (str(self.folder / name) for name in ("s.json", "short.json", "page.md"))
        command = [sys.executable, "-B", str(root / "scripts/survey_gltf.py"), f"x={self.folder}/a+b", "--corpus", str(self.folder)]
        done = subprocess.run([*command, *options, "--render", render, "--json", survey_json, "--summary", short, "--page", text, "--quiet"], check=False)
        self.assertEqual(done.returncode, 0)
        written = pathlib.Path(text).read_text()
        self.assertIn("| a/b | 0123456789 | 2 | 1 (50 %) | 1 |", written)
        self.assertIn("wrong\\|&lt;b>.gltf", written)
        self.assertNotIn(str(self.folder), written)
        again = page.page_of(summary.summary_of(json.loads(pathlib.Path(survey_json).read_text())), "short.json")
        self.assertEqual(again, written)

    def test_a_small_file_that_takes_much_is_named(self):
        small = {"source": "s", "file": "f.glb", "bytes": 1000, "cpu_seconds": 6, "peak_mib": 10}
        self.assertTrue(summary.is_costly(small))
        self.assertFalse(summary.is_costly({**small, "bytes": 3_000_000}))
        self.assertFalse(summary.is_costly({**small, "cpu_seconds": 4}))


os.environ.pop("PYTHONPATH", None)
unittest.main(argv=[sys.argv[0]])
