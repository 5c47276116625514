"""Contact sheets of the rendered images. Needs the package Pillow."""

import os
import tempfile

from . import runs

COLUMNS, ROWS = 6, 4
LABEL = 26  # pixels below each picture


def pillow():
    """The modules of Pillow, or None."""
    try:
        from PIL import Image, ImageDraw

        return Image, ImageDraw
    except ImportError:
        return None


def picture_of(renderer, file, image):
    """The image of a file at the sheet's size, or None if it was not rendered."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture.png")
        run = runs.Run(renderer.command(file.path, path, os.path.join(folder, "run.json")), renderer.timeout, renderer.memory_mib)
        if run.status:
            return None
        with image.open(path) as picture:
            return picture.convert("RGB")


def write(folder, renderer, files, jobs):
    """Writes sheet-000.png and so on, with the file name below each image. Returns the number of images."""
    image, draw = pillow()
    width, height = (int(n) for n in renderer.size.split("x"))
    os.makedirs(folder, exist_ok=True)
    shown = 0
    for number, first in enumerate(range(0, len(files), COLUMNS * ROWS)):
        part = files[first : first + COLUMNS * ROWS]
        pictures = runs.each(part, jobs, lambda file: picture_of(renderer, file, image))
        sheet = image.new("RGB", (COLUMNS * width, -(-len(part) // COLUMNS) * (height + LABEL)), "white")
        pen = draw.Draw(sheet)
        for i, (file, picture) in enumerate(zip(part, pictures)):
            x, y = i % COLUMNS * width, i // COLUMNS * (height + LABEL)
            if picture:
                sheet.paste(picture, (x, y))
                shown += 1
            letters = width // 6 - 1
            name = file.name if picture else "not rendered: " + file.name
            pen.text((x + 2, y + height + 1), file.source[-letters:], fill="grey")
            pen.text((x + 2, y + height + 12), name[-letters:], fill="black")
        sheet.save(os.path.join(folder, f"sheet-{number:03}.png"))
    return shown
