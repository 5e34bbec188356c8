#!/usr/bin/env python3
"""Packs recorded movement traces (CSV, a row a tic) into the small text files beside this script.

usage: convert.py DIRECTORY_OF_CSV_FILES

A packed file starts with the state in 65536ths of a map unit (x y z vx vy vz, then h, the eye above the feet),
millionths of a degree (a angle, p pitch) and g (on the ground). `> ACTION` holds until the next one. Then each line is a
tic: what changed, a letter and the difference to the tic before; `.` for nothing, `.5` for nothing over 5 tics.
Files with equal content are stored once, under the first name.
"""
import csv
import pathlib
import sys

UNIT, DEGREE, ONE = 65536, 1_000_000, 1
COLUMNS = [
    ("x", "POSITION_X", UNIT), ("y", "POSITION_Y", UNIT), ("z", "POSITION_Z", UNIT),
    ("u", "VELOCITY_X", UNIT), ("v", "VELOCITY_Y", UNIT), ("w", "VELOCITY_Z", UNIT),
    ("h", "VIEW_HEIGHT", UNIT), ("a", "ANGLE", DEGREE), ("p", "PITCH", DEGREE), ("g", "ON_GROUND", ONE),
]


def pack(path):
    lines, previous, action, quiet = [], None, None, 0
    for row in csv.DictReader(path.open()):
        if row["action"] == "FINISHED":
            break
        now = [round(float(row[name]) * scale) for _, name, scale in COLUMNS]
        camera = round(float(row["CAMERA_POSITION_Z"]) * UNIT)
        assert camera == now[2] + now[6], f"{path.name}, tic {row['tic']}: camera is not feet + view height"
        if previous is None:
            lines.append(" ".join(f"{letter}{value}" for (letter, _, _), value in zip(COLUMNS, now)))
            previous = now
            continue
        changes = " ".join(f"{c[0]}{n - p}" for c, n, p in zip(COLUMNS, now, previous) if n != p)
        if (row["action"] != action or changes) and quiet:
            lines.append("." if quiet == 1 else f".{quiet}")
            quiet = 0
        if row["action"] != action:
            action = row["action"]
            lines.append(f"> {action}")
        if changes:
            lines.append(changes)
        else:
            quiet += 1
        previous = now
    if quiet:
        lines.append("." if quiet == 1 else f".{quiet}")
    return "\n".join(lines) + "\n"


def main():
    seen = {}
    here = pathlib.Path(__file__).parent
    for path in sorted(pathlib.Path(sys.argv[1]).glob("*.csv")):
        if not path.name.startswith(("ArmamentBurden", "PrecipicePlunge")):
            continue
        text = pack(path)
        if text in seen:
            print(f"{path.name}: same as {seen[text]}")
            continue
        seen[text] = path.name
        (here / path.with_suffix(".trace").name).write_text(text)


main()
