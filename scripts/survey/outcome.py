"""Classifies a run of tandem-render by its exit status and its standard error."""

import re

DRAWN = "drawn"  # no note
NOTES = "drawn with notes"  # something approximated or left out, and said so
REFUSED = "refused"  # status 2 and a sentence
ENVIRONMENT = "environment"  # status 3: the machine lacks something
CRASH = "crash"  # a signal
HANG = "hang"  # killed after the time limit
ODD = "odd status"  # any other status, a refusal without a sentence, or a film that is not there
OUTCOMES = (DRAWN, NOTES, REFUSED, ENVIRONMENT, CRASH, HANG, ODD)
BAD = (CRASH, HANG, ODD)

PREFIX = "tandem-render: "
NOTE = re.compile(r"(approximated|ignored): (.*)", re.S)
USES = re.compile(r" \((\d+) uses\)(?=:|$)")


def note_of(line):
    """(treatment, feature, uses) of a line such as 'ignored: skin at skins[0] (2 uses): why', or None."""
    match = NOTE.match(line)
    if not match:
        return None
    uses = USES.search(match[2])
    feature = re.split(r" at (?=\S)| \(\d+ uses\)|: |, ", match[2])[0]
    return [match[1], feature, int(uses[1]) if uses else 1]


def parts_of(errors):
    """(notes, message) of a standard error. A message may have several lines; a note has one."""
    notes, sentence = [], []
    for line in errors.splitlines():
        text = line[len(PREFIX) :] if line.startswith(PREFIX) else line
        note = note_of(text) if line.startswith(PREFIX) else None
        if note:
            notes.append(note)
        elif text.strip():
            sentence.append(text)
    return notes, "\n".join(sentence)


def outcome_of(status, timed_out, sentence, notes, has_film):
    """`status` as of subprocess: negative for a signal."""
    if timed_out:
        return HANG
    if status < 0:
        return CRASH
    if status == 0 and has_film:
        return NOTES if notes else DRAWN
    if status == 2 and sentence and not has_film:
        return REFUSED
    if status == 3 and sentence and not has_film:
        return ENVIRONMENT
    return ODD


def anonymous(sentence, path):
    """The message without machine paths: the scene becomes FILE, its folder is left out."""
    folder = path[: len(path) - len(path.rsplit("/", 1)[-1])]
    text = sentence.replace(path, "FILE")
    return text.replace(folder, "") if len(folder) > 1 else text


def group_of(sentence):
    """The sentence with its varying parts replaced, so that equal reasons become equal: numbers by #, names by '…'.

    Names of extensions stay. Of several lines only the first counts.
    """
    text = sentence.split("\n")[0]
    text = re.sub(r"(?<!\w)'(?!(?:[A-Z0-9]{2,}_)\w+')[^']*'", "'…'", text)
    text = re.sub(r"(?<![A-Za-z_])[-+]?\d+(?:[,.]\d+)*(?:e[-+]?\d+)?(?![A-Za-z_])", "#", text)
    text = re.sub(r"FILE: (?:[\w\[\]#.]+(?:\.\w+|\[#\]))+(?=[ :])", "FILE: PATH", text)
    return text
