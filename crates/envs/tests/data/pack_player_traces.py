#!/usr/bin/env python3
"""Packs recorded player traces (CSV files of the original) into player_traces.csv.gz.

Usage: pack_player_traces.py FOLDER OUT. A row a tic: file, action, then x, y, z, velocity x, y, z and camera z in
65536ths of a map unit, angle and pitch in millionths of a degree. Row 0 of each trace (action `start`) is the state
that the replay starts from.
"""
import csv, glob, gzip, os, sys

COLUMNS = ["POSITION_X", "POSITION_Y", "POSITION_Z", "VELOCITY_X", "VELOCITY_Y", "VELOCITY_Z", "CAMERA_POSITION_Z"]

folder, out = sys.argv[1:]
with gzip.GzipFile(out, "wb", mtime=0) as packed:
    for path in sorted(glob.glob(os.path.join(folder, "*L1_seed*.csv"))):
        name = os.path.basename(path)[: -len(".csv")]
        if name.startswith("objs_"):
            continue
        for row in csv.DictReader(open(path)):
            if row["action"] == "FINISHED" or not row["POSITION_X"]:
                break
            numbers = [round(float(row[c]) * 65536) for c in COLUMNS]
            numbers += [round(float(row[c]) * 1e6) for c in ("ANGLE", "PITCH")]
            packed.write(",".join([name, row["action"], *map(str, numbers)]).encode() + b"\n")
